// The three tables of a run, of a method that does as it is told.

#include "tools/touchstone/recorder.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace touchstone::program {
namespace {

/// Its state and contacts are set from outside.
template <int Dim>
class Puppet final : public Method<Dim> {
 public:
  explicit Puppet(Scene<Dim> scene) : state_(initial_state(scene)), scene_(std::move(scene)) {}

  Capabilities capabilities() const override { return capabilities_; }
  const Scene<Dim>& scene() const override { return scene_; }
  std::span<const BodyState<Dim>> state() const override { return state_; }
  std::span<const ContactImpulse<Dim>> contacts() const override { return contacts_; }
  StepReport step(double) override { return {}; }
  Options effective_options() const override { return {}; }
  std::span<const StateError<Dim>> error_estimate() const override { return errors_; }

  std::vector<StateError<Dim>> errors_;
  Capabilities capabilities_;
  std::vector<BodyState<Dim>> state_;
  std::vector<ContactImpulse<Dim>> contacts_;

 private:
  Scene<Dim> scene_;
};

/// Balls over the ground, named as given.
template <int Dim>
Scene<Dim> balls(const std::vector<std::string>& names) {
  Scene<Dim> scene;
  scene.gravity[Dim - 1] = -10;
  for (const std::string& name : names) {
    Body<Dim> ball{.name = name, .mass = 2};
    ball.pose.position[Dim - 1] = 1;
    ball.pose.position[0] = 4.0 * static_cast<double>(scene.bodies.size());
    scene.bodies.push_back(ball);
  }
  Body<Dim> ground{.name = "ground", .fixed = true};
  ground.shape.geometry = HalfSpace<Dim>{};
  scene.bodies.push_back(ground);
  return scene;
}

template <int Dim>
struct Recording {
  Puppet<Dim> method;
  Judge<Dim> judge;
  EnergyLedger<Dim> ledger;
  Recorder<Dim> recorder;

  explicit Recording(const std::vector<std::string>& names)
      : method(balls<Dim>(names)),
        judge(method.scene()),
        ledger(method.scene(), judge, method.state()),
        recorder(method) {}

  std::string file(const std::string& name) const {
    for (const auto& file : recorder.files("out")) {
      if (file.path == std::filesystem::path("out") / name) return file.bytes;
    }
    return "no such file";
  }
};

const char* const kTrajectoryHeader =
    "t_s,body,px_m,py_m,pz_m,qw,qx,qy,qz,vx_m_s,vy_m_s,vz_m_s,wx_rad_s,wy_rad_s,wz_rad_s\n";
const char* const kContactsHeader =
    "t_s,body_a,body_b,gap_m,normal_N,tangent_t_N,tangent_o_N,torsion_Nm,slip_m_s,spin_rad_s\n";
const char* const kEnergyHeader = "t_s,kinetic_J,potential_J,total_J,friction_loss_J,impact_loss_J,drift_J\n";

TEST(Recorder, WritesOneRowAMovingBodyAndTime) {
  Recording<3> run({"b10", "b9"});
  run.method.state_[0].velocity << 1, 2, 3, 4, 5, 6;
  run.method.state_[1].pose.rotation = SpatialRotation(Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5));
  run.recorder.record(0, 0, run.ledger);
  run.recorder.record(0.1, 0.1, run.ledger);
  const std::string rows[] = {",b9,4,0,1,0.5,0.5,-0.5,0.5,0,0,0,0,0,0\n", ",b10,0,0,1,1,0,0,0,1,2,3,4,5,6\n"};
  EXPECT_EQ(run.file("trajectory.csv"),
            kTrajectoryHeader + ("0" + rows[0]) + "0" + rows[1] + "0.1" + rows[0] + "0.1" + rows[1])
      << "no row for the ground; sorted by name, numbers by value";
}

TEST(Recorder, PutsThePlaneIntoSpace) {
  Recording<2> run({"disc"});
  run.method.state_[0].pose = {{3, 4}, PlanarRotation(std::numbers::pi / 3)};
  run.method.state_[0].velocity = {5, 6, 7};
  run.recorder.record(0, 0, run.ledger);
  const std::string text = run.file("trajectory.csv");
  const harness::Table table = harness::parse_csv(text, "trajectory.csv");
  ASSERT_EQ(table.rows.size(), 1u);
  const harness::Row& row = table.rows[0];
  EXPECT_EQ(harness::Row(row.begin() + 2, row.begin() + 5), (harness::Row{"3", "4", "0"}));
  double w = 0;
  double z = 0;
  ASSERT_TRUE(harness::parse_number(row[5], w) && harness::parse_number(row[8], z));
  EXPECT_NEAR(w, std::cos(std::numbers::pi / 6), 1e-15);
  EXPECT_NEAR(z, 0.5, 1e-15);
  EXPECT_EQ(row[6] + row[7], "00");
  EXPECT_EQ(harness::Row(row.begin() + 9, row.end()), (harness::Row{"5", "6", "0", "0", "0", "7"}));
}

ContactImpulse<3> contact_of(int ball) {
  ContactImpulse<3> contact;
  contact.body_a = ball;
  contact.body_b = 2;
  contact.point_a = {4.0 * ball, 0, 0};
  contact.point_b = contact.point_a;
  contact.normal = {0, 0, 1};
  contact.tangents << 1, 0, 0, 1, 0, 0;
  contact.normal_impulse = 2;
  contact.friction_impulse = {0.25, -0.5, 0.125};
  return contact;
}

TEST(Recorder, WritesForcesAndWhatTheJudgeSeesAtTheContact) {
  Recording<3> run({"b", "a"});
  run.method.contacts_ = {contact_of(0), contact_of(1)};
  // The lowest point of b moves with v + omega x (0, 0, -1) = (3 - omega_y, 0, 0), and spins with omega_z.
  run.method.state_[0].velocity << 3, 0, 0, 0, 7, -5;
  run.method.state_[1].pose.position.z() = 1.25;
  run.recorder.record(0.5, 0.5, run.ledger);
  EXPECT_EQ(run.file("contacts.csv"), std::string(kContactsHeader) +
                                          "0.5,a,ground,0.25,4,0.5,-1,0.25,0,0\n"
                                          "0.5,b,ground,0,4,0.5,-1,0.25,4,-5\n")
      << "the gap is the distance of the bodies, whatever the contact's points say";
}

TEST(Recorder, WritesNoContactAtTheStart) {
  Recording<3> run({"b", "a"});
  run.method.contacts_ = {contact_of(0)};
  run.recorder.record(0, 0, run.ledger);
  EXPECT_EQ(run.file("contacts.csv"), kContactsHeader);
}

TEST(Recorder, WritesThePlanesContacts) {
  Recording<2> run({"disc"});
  ContactImpulse<2> contact;
  contact.body_b = 1;
  contact.normal = {0, 1};
  contact.tangents = Vector<2>(1, 0);
  contact.normal_impulse = 2;
  contact.friction_impulse[0] = -1;
  run.method.contacts_ = {contact};
  run.method.state_[0].velocity = {-3, 0, 1};
  run.recorder.record(0.5, 0.5, run.ledger);
  EXPECT_EQ(run.file("contacts.csv"), std::string(kContactsHeader) + "0.5,disc,ground,0,4,-2,0,0,2,0\n");
}

TEST(Recorder, WritesEnergyAndWhereItWent) {
  Recording<2> run({"disc"});
  run.recorder.record(0, 0, run.ledger);
  std::vector<BodyState<2>> before = run.method.state_;
  run.method.state_[0].velocity[0] = 1;
  run.ledger.book(0.5, before, run.method.state_, {}, {});
  run.recorder.record(0.5, 0.5, run.ledger);
  EXPECT_EQ(run.file("energy.csv"), std::string(kEnergyHeader) + "0,0,20,20,0,0,0\n0.5,1,20,21,0,0,1\n");
}

TEST(Recorder, WritesWhatAMethodTakesItsStateToBeOff) {
  Recording<3> run({"b", "a"});
  EXPECT_EQ(run.file("error_estimate.csv"), "no such file") << "no estimate, no file";
  run.method.errors_.resize(3);  // two balls and the ground
  run.method.errors_[0].position = {0, 3, 4};
  run.method.errors_[0].turn = {0.5, 0, 0};
  run.method.errors_[0].velocity << 0, 0, 2, 6, 8, 0;
  run.recorder.record(0.5, 0.5, run.ledger);
  EXPECT_EQ(run.file("error_estimate.csv"),
            "t_s,body,position_m,turn_rad,velocity_m_s,angular_velocity_rad_s\n"
            "0.5,a,0,0,0,0\n"
            "0.5,b,5,0.5,2,10\n");
}

TEST(Recorder, LeavesLossesEmptyThatAMethodDoesNotTell) {
  Recording<2> run({"disc"});
  run.method.capabilities_.contact_impulses = false;
  run.recorder.record(0, 0, run.ledger);
  EXPECT_EQ(run.file("energy.csv"), std::string(kEnergyHeader) + "0,0,20,20,,,\n");
}

}  // namespace
}  // namespace touchstone::program
