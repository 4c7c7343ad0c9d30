#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "experiments/harness/case.h"
#include "experiments/harness/run_case.h"
#include "experiments/scenarios/disc_rolling_truths.h"

/// What disc_rolling writes of a case: the truths that stand beside it, and its rows.
namespace touchstone::disc_rolling {

inline const DiscRolling kDisc;
inline const std::vector<double> kReportTimes = {1, 2, 5, 10};  // [s]
inline constexpr int kSamples = 200;                            ///< of a curve
inline constexpr int kEngineSamples = 20;                       ///< of a curve of the sweep `engines`
inline constexpr double kUntilOfCheck = 2.0;                    // [s]
inline constexpr long kMostEngineSteps = 10'000;                ///< of a case of the sweep `engines`

/// One place in a sweep: what is run and compared there.
struct Point {
  std::string sweep;
  int edges = 0;  ///< 0: the disc itself
  double h = 0.0;
  double until = 0.0;
};

/// Columns of summary.csv and kinetic_energy.csv.
const std::vector<std::string>& summary_columns();
const std::vector<std::string>& curve_columns();

/// The exact polygon by number of edges.
using ExactPolygons = std::map<int, ExactPolygon>;

/// How many samples of its motion a case at `point` keeps.
int samples_of(const Point& point);
/// As many equally spaced times from 0 to the horizon [s], both included.
std::vector<double> sample_times(const Point& point);

/// Whether `key` in --methods is one of the truths.
bool is_truth(const std::string& key);

/// The curve that stands under `key` in --methods, or none if that is no truth.
/// @param truths  holds every number of edges that is asked for, and must outlive the curve
std::optional<EnergyCurve> truth_curve(const std::string& key, const Point& point,
                                       const ExactPolygons& truths);

/// Rows of a method's case. @param polygon  null if the method rolls the disc itself
std::vector<std::vector<harness::Row>> method_rows(const harness::CaseRun<2>& run, const Point& point,
                                                   const ExactPolygon* polygon);

/// Rows of a truth, in the same form.
harness::CaseResult truth_result(const EnergyCurve& truth, const Point& point);

}  // namespace touchstone::disc_rolling
