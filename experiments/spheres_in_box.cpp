// Question: does a step with many contacts get solved, whatever their number, and what becomes of the energy?
// Success criterion: the implicit NCP solves every step of the fall, Eqs. 10-11 to 1e-10 by the judge,
// without penetration; friction and plastic impacts account for the energy. Source: the scene is ours;
// spheres that settle in a box are the usual trial of many contacts, as in E. G. Drumwright and D. A. Shell,
// "Extensive analysis of linear complementarity problem (LCP) solver performance on randomly generated rigid
// body contact problems", IROS 2012. Expected: the box grows in all directions, so that where
// the spheres have met contacts come to about two a sphere and to one island whatever n is; a larger heap
// takes longer to meet. The time of a step, which is not in this table, is for spheres_in_box_scaling.

#include "experiments/scenarios/spheres_in_box.h"

#include <algorithm>
#include <memory>
#include <numeric>

#include "experiments/harness/account_columns.h"
#include "experiments/harness/experiment.h"
#include "experiments/harness/method_case.h"

namespace {

using namespace touchstone;
using namespace touchstone::harness;

const std::vector<std::string> kSummary =
    with_account({"contacts", "contacts_per_sphere", "listed_contacts", "islands", "largest_island",
                  "fallen_m", "end_kinetic_J"});
const std::vector<std::string> kHistory = {"t_s",     "contacts",       "listed_contacts",
                                           "islands", "largest_island", "kinetic_J"};

/// Islands of spheres that contacts with an impulse hold together; a sphere that touches none is one of its
/// own.
struct Connected {
  long contacts = 0;  ///< with an impulse
  long islands = 0;
  long largest = 0;  ///< spheres of the largest
};

Connected connected(const std::vector<ContactImpulse<3>>& contacts, int spheres) {
  std::vector<int> parent(static_cast<std::size_t>(spheres));
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[static_cast<std::size_t>(i)] != i) i = parent[static_cast<std::size_t>(i)];
    return i;
  };
  Connected result;
  for (const auto& contact : contacts) {
    if (!(contact.normal_impulse > 0)) continue;
    ++result.contacts;
    if (contact.body_a >= spheres || contact.body_b >= spheres) continue;
    const auto [first, last] = std::minmax({root(contact.body_a), root(contact.body_b)});
    parent[static_cast<std::size_t>(last)] = first;
  }
  std::vector<long> size(static_cast<std::size_t>(spheres), 0);
  for (int i = 0; i < spheres; ++i) ++size[static_cast<std::size_t>(root(i))];
  result.islands = spheres - std::count(size.begin(), size.end(), 0);
  result.largest = *std::max_element(size.begin(), size.end());
  return result;
}

std::vector<std::vector<Row>> rows(const SpheresInBox& box, const CaseRun<3>& run) {
  Record summary(kSummary);
  std::vector<Row> history;
  const int n = box.spheres;
  for (std::size_t k = 0; k < run.kept.size(); ++k) {
    const Connected now = connected(run.kept[k].contacts, n);
    const auto listed = static_cast<long>(run.kept[k].contacts.size());
    Record row(kHistory);
    row.set("t_s", run.kept[k].t_s).set("contacts", now.contacts).set("listed_contacts", listed);
    row.set("islands", now.islands).set("largest_island", now.largest);
    if (k < run.samples.size()) row.set("kinetic_J", run.samples[k].energy.kinetic);
    history.push_back(row.row());
    if (k + 1 < run.kept.size()) continue;
    summary.set("contacts", now.contacts).set("contacts_per_sphere", static_cast<double>(now.contacts) / n);
    summary.set("listed_contacts", listed).set("islands", now.islands).set("largest_island", now.largest);
  }
  double fallen = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i)
    fallen += run.kept.front().state[i].pose.position.z() - run.end[i].pose.position.z();
  summary.set("fallen_m", fallen / n).set("end_kinetic_J", run.final.kinetic);
  set_account(summary, run);
  return {{summary.row()}, history};
}

std::vector<Case> cases(const Selection& selection) {
  std::vector<Case> all;
  for (const int n : selection.integers("spheres")) {
    SpheresInBox box;
    box.spheres = n;
    const auto scene = std::make_shared<Scene<3>>(spheres_in_box_scene(box));
    for (const double h : selection.numbers("step-sizes")) {
      for (const MethodSpec& method : selection.methods) {
        MethodCase<3> spec;
        spec.scenario = "spheres_in_box";
        spec.scene = scene;
        spec.method = method;
        spec.sweep = {number_cell(static_cast<long>(n))};
        spec.run = {.h = h, .until = selection.until, .samples = 10000, .ledger = true, .keep_steps = true};
        spec.cost_of_step = n;
        spec.tabulate = [box](const CaseRun<3>& run) { return rows(box, run); };
        all.push_back(make_case(std::move(spec)));
      }
    }
  }
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  const Experiment experiment = {
      .command_line = {.name = "spheres_in_box",
                       .about = "Does a step with many contacts get solved, and what becomes of the energy?",
                       .examples =
                           "  spheres_in_box                                  what is committed\n"
                           "  spheres_in_box --spheres 1000 --out /tmp/heap   a larger heap, minutes\n",
                       .methods = {"implicit_ncp"},
                       .axes = {{"spheres",
                                 "number n of spheres",
                                 AxisKind::integer,
                                 {"10", "30", "100", "300"},
                                 {"10", "30"}},
                                {"step-sizes", "step sizes h [s]", AxisKind::positive, {"0.01"}, {"0.01"}}},
                       .until = 0.2,
                       .quick_until = 0.2},
      .sweep_columns = {"spheres"},
      .tables = {{"summary", kSummary}, {"history", kHistory}},
      .seed = static_cast<long>(SpheresInBox{}.seed),
      .cases = cases};
  return run_experiment(experiment, argc, argv);
}
