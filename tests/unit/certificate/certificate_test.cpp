// Every component of a correct answer, spoilt by 1e-8, is found by the checker at 1e-10 and named; the
// correct answers come from the implicit stepper, which the checker shares nothing with.
#include "core/certificate/certificate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "core/certificate/separation.h"
#include "core/stepper/implicit_stepper.h"

namespace touchstone::certificate {
namespace {

constexpr double kSpoilt = 1e-8;
constexpr double kTolerance = 1e-10;

/// A step's problem and answer, to be spoilt.
template <int Dim>
struct Answer {
  Scene<Dim> scene;
  std::vector<BodyState<Dim>> before, after;
  std::vector<ContactImpulse<Dim>> contacts;
  std::vector<JointImpulse<Dim>> joints;
  std::vector<std::array<std::vector<double>, 2>> multipliers;
  double h = 0.01;

  [[nodiscard]] Step<Dim> step() const { return {before, after, contacts, joints, h, multipliers}; }
  [[nodiscard]] Report certify() const { return Checker<Dim>(scene).certify(step()); }
};

/// The answer after `steps` steps of the implicit stepper.
template <int Dim>
Answer<Dim> solved(const Scene<Dim>& scene, int steps) {
  Answer<Dim> answer;
  answer.scene = scene;
  ImplicitStepper<Dim> stepper(scene, {});
  for (int k = 0; k < steps; ++k) {
    answer.before.assign(stepper.state().begin(), stepper.state().end());
    EXPECT_EQ(stepper.step(answer.h).status, StepStatus::solved) << k;
  }
  answer.after.assign(stepper.state().begin(), stepper.state().end());
  answer.contacts.assign(stepper.contacts().begin(), stepper.contacts().end());
  answer.joints.assign(stepper.joints().begin(), stepper.joints().end());
  for (std::size_t i = 0; i < answer.contacts.size(); ++i) {
    const std::vector<double>& both = stepper.contact_solution(i).multipliers;
    const auto& body = scene.bodies[static_cast<std::size_t>(answer.contacts[i].body_a)];
    const auto surface = make_surface(body.shape);
    const auto first = make_side(*surface).multipliers();
    answer.multipliers.push_back({std::vector<double>(both.begin(), both.begin() + first),
                                  std::vector<double>(both.begin() + first, both.end())});
  }
  return answer;
}

template <int Dim>
Body<Dim> half_space() {
  Body<Dim> ground{.name = "ground", .fixed = true};
  ground.shape.geometry = HalfSpace<Dim>{};
  return ground;
}

/// An ellipsoid that slides and spins on the ground, with anisotropic friction and torsion.
Scene<3> sliding() {
  Scene<3> scene;
  scene.gravity = {0, 0, -9.81};
  scene.contact_law = {
      .mu = 0.3, .e_t = 1.0, .e_o = 0.7, .e_r = 0.2, .tangent = Vector<3>(1, 1, 0).normalized()};
  Body<3> body{.name = "egg", .mass = 2.0};
  body.inertia = Vector<3>(0.4, 0.5, 0.6).asDiagonal();
  body.pose.position = {0, 0, 0.6};
  body.velocity << 1, 0.5, 0, 0.3, 2, 1;
  body.shape.geometry = Ellipsoid<3>{{1.0, 0.8, 0.6}};
  scene.bodies = {body, half_space<3>()};
  return scene;
}

/// A box that lies on the ground, pushed, and one that stands beside it.
Scene<3> resting() {
  Scene<3> scene;
  scene.gravity = {0, 0, -9.81};
  scene.contact_law.mu = 0.5;
  Body<3> box{.name = "box"};
  box.pose.position = {0, 0, 0.3};
  box.force = {1, 0.5, 0};
  box.shape.geometry = Box<3>{{0.5, 0.4, 0.3}};
  Body<3> other = box;
  other.name = "other";
  other.pose.position = {5, 0, 0.3};
  scene.bodies = {box, half_space<3>(), other};
  return scene;
}

template <int Dim>
void expect_correct(const Answer<Dim>& answer) {
  const Report report = answer.certify();
  EXPECT_TRUE(report.holds(1e-12)) << Checker<Dim>(answer.scene).describe(report, answer.step());
}

/// One way to spoil an answer and the condition that it breaks first of all.
struct Spoiling {
  const char* what;
  std::function<void(Answer<3>&)> spoil;
  Condition broken;
};

void expect_found(const Answer<3>& correct, const std::vector<Spoiling>& spoilings) {
  for (const auto& [what, spoil, broken] : spoilings) {
    Answer<3> answer = correct;
    spoil(answer);
    const Report report = answer.certify();
    EXPECT_FALSE(report.holds(kTolerance)) << what;
    EXPECT_GT(report.residual(broken), kTolerance) << what << ": not named is " << to_string(broken);
  }
}

TEST(Certificate, HoldsForTheSteppersAnswers) {
  expect_correct(solved(sliding(), 3));
  expect_correct(solved(resting(), 3));
}

using enum Condition;

TEST(Certificate, NamesWhatIsSpoiltOfASlidingBody) {
  const Answer<3> correct = solved(sliding(), 3);
  ASSERT_GT(std::abs(correct.contacts.at(0).friction_impulse[2]), 1e-4) << "it spins";
  std::vector<Spoiling> all = {
      {"an orientation",
       [](auto& a) {
         a.after[0].pose.rotation = a.after[0].pose.rotation.turned({kSpoilt, 0, 0});
       },
       orientation},
      {"a normal impulse", [](auto& a) { a.contacts[0].normal_impulse += kSpoilt; }, linear_momentum},
      {"a normal impulse that pulls", [](auto& a) { a.contacts[0].normal_impulse *= -1; }, normal_impulse},
      {"the normal", [](auto& a) { a.contacts[0].normal[0] += kSpoilt; }, normal},
      {"the normal's length", [](auto& a) { a.contacts[0].normal *= 1 + kSpoilt; }, frame},
      {"the tangents' directions",
       [](auto& a) {
         const Matrix<3> turn = Eigen::AngleAxisd(kSpoilt, a.contacts[0].normal).toRotationMatrix();
         a.contacts[0].tangents = turn * a.contacts[0].tangents;
       },
       frame},
      {"a gap: penetration", [](auto& a) { a.contacts[0].point_a[2] -= kSpoilt; }, gap},
      {"a gap: a force from afar", [](auto& a) { a.contacts[0].point_a[2] += kSpoilt; }, complementarity},
      {"a point off its surface", [](auto& a) { a.contacts[0].point_a[2] += kSpoilt; }, surface},
      {"a point along its surface", [](auto& a) { a.contacts[0].point_a[0] += kSpoilt; }, opposite},
      {"a point of the ground off it", [](auto& a) { a.contacts[0].point_b[2] += kSpoilt; }, surface},
      {"a speed that is not finite",
       [](auto& a) { a.after[0].velocity[1] = std::numeric_limits<double>::quiet_NaN(); }, finite},
  };
  for (int k = 0; k < 3; ++k) {
    all.push_back({"a position", [k](auto& a) { a.after[0].pose.position[k] += kSpoilt; }, position});
    all.push_back({"a velocity", [k](auto& a) { a.after[0].velocity[k] += kSpoilt; }, linear_momentum});
    all.push_back(
        {"an angular velocity", [k](auto& a) { a.after[0].velocity[3 + k] += kSpoilt; }, angular_momentum});
    all.push_back(
        {"a friction impulse", [k](auto& a) { a.contacts[0].friction_impulse[k] += kSpoilt; }, dissipation});
  }
  // Both bodies' points together: the geometry is right still, but not at the closest points.
  all.push_back({"both points",
                 [](auto& a) {
                   a.contacts[0].point_a[1] += 1e-4;
                   a.contacts[0].point_b[1] += 1e-4;
                 },
                 normal});
  expect_found(correct, all);
}

TEST(Certificate, NamesWhatIsSpoiltOfARestingBody) {
  const Answer<3> correct = solved(resting(), 3);
  ASSERT_EQ(correct.contacts.size(), 2U);
  const auto active = [](const Answer<3>& a) {
    const auto& l = a.multipliers[0][0];
    return static_cast<std::size_t>(std::max_element(l.begin(), l.end()) - l.begin());
  };
  std::vector<Spoiling> all = {
      {"a multiplier of the face", [&](auto& a) { a.multipliers[0][0][active(a)] += kSpoilt; }, multipliers},
      {"a multiplier of another face", [&](auto& a) { a.multipliers[0][0][(active(a) + 1) % 6] += kSpoilt; },
       multipliers},
      {"a multiplier below zero", [&](auto& a) { a.multipliers[0][0][(active(a) + 2) % 6] -= kSpoilt; },
       multipliers},
      {"slip where it sticks", [](auto& a) { a.after[0].velocity[0] += kSpoilt; }, slip_outside},
      {"friction outside the cone",
       [](auto& a) {
         a.contacts[0].friction_impulse.template head<2>() *=
             (0.5 + kSpoilt) * a.contacts[0].normal_impulse /
             a.contacts[0].friction_impulse.template head<2>().norm();
       },
       friction_cone},
      {"torsion without a semi-axis", [](auto& a) { a.contacts[0].friction_impulse[2] = kSpoilt; },
       friction_cone},
      {"friction that does not slow the slip",
       [](auto& a) {
         a.contacts[0].friction_impulse.setZero();
         a.after[0].velocity[0] += 0.1;
       },
       slip_outside},
      {"a contact left out, of bodies that overlap",
       [](auto& a) {
         a.contacts.erase(a.contacts.begin());
         a.multipliers.erase(a.multipliers.begin());
         a.after[0].pose.position[2] -= 1e-4;
       },
       separation},
  };
  for (int k = 0; k < 3; ++k) {
    all.push_back({"where the load acts",
                   [k](auto& a) {
                     if (k == 2) return void(a.contacts[0].point_a[k] += kSpoilt);
                     a.contacts[0].point_a[k] += kSpoilt;
                     a.contacts[0].point_b[k] += kSpoilt;
                   },
                   k == 2 ? surface : angular_momentum});
  }
  expect_found(correct, all);
}

TEST(Certificate, NamesJointsThatComeApart) {
  Scene<2> scene;
  scene.gravity = {0, -9.81};
  Body<2> bob{.name = "bob"};
  bob.pose.position = {1, 0};
  bob.shape.geometry = Sphere<2>{0.1};
  Body<2> nail{.name = "nail", .fixed = true};
  nail.shape.geometry = Sphere<2>{0.1};
  scene.bodies = {bob, nail};
  scene.joints = {{.type = JointType::hinge, .body_a = 0, .body_b = 1}};
  const Answer<2> correct = solved(scene, 3);
  expect_correct(correct);
  Answer<2> answer = correct;
  answer.after[0].pose.position[0] += kSpoilt;
  EXPECT_GT(answer.certify().residual(joint), kTolerance);
  answer = correct;
  answer.joints[0].on_a[1] += kSpoilt;
  EXPECT_EQ(answer.certify().worst_condition(), linear_momentum);
  EXPECT_EQ(Checker<2>(scene).describe(answer.certify(), answer.step()).rfind("linear momentum of bob: ", 0),
            0U);
}

TEST(Separation, HasTheSignOfTheDistance) {
  const auto box = make_surface<3>({Box<3>{{1, 1, 1}}, {}});
  const auto ball = make_surface<3>({Sphere<3>{1.0}, {}});
  for (const double gap : {1.0, 1e-3, 1e-6, -1e-3, -0.5}) {
    const double found = certificate::separation<3>(*box, {}, *ball, {{0.3, 0.2, 2 + gap}, {}});
    EXPECT_EQ(found > 0, gap > 0) << gap << ": " << found;
  }
}

}  // namespace
}  // namespace touchstone::certificate
