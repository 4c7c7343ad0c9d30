#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <array>
#include <cstring>
#include <stdexcept>

#include "baselines/engines/engines.h"
#include "baselines/engines/mujoco_model.h"
#include "baselines/engines/read_back.h"
#include "baselines/engines/shapes.h"
#include "baselines/engines/spatial_engine.h"

/// MuJoCo 2.2: spatial, double precision, soft contacts as a convex problem in accelerations, Newton's
/// method.
namespace touchstone::engines {

namespace {

enum class Cone { elliptic, pyramidal };
enum class Softness { standard, stiff };

MujocoSettings read_settings(OptionReader& read, Cone cone, Softness softness) {
  // Standard is MuJoCo's own. Stiff asks for less than the two steps that MuJoCo allows, and so gets them,
  // with an impedance near 1, which is as rigid as MuJoCo's contacts become.
  const bool stiff = softness == Softness::stiff;
  MujocoSettings s{};
  s.cone = cone == Cone::elliptic ? "elliptic" : "pyramidal";
  s.timeconst = read.number("timeconst", stiff ? 1e-6 : 0.02, 1e-9, 1e3);
  s.dampratio = read.number("dampratio", 1.0, 1e-3, 1e3);
  s.dmin = read.number("dmin", stiff ? 0.99 : 0.9, 1e-4, 0.9999);
  s.dmax = read.number("dmax", stiff ? 0.999 : 0.95, 1e-4, 0.9999);
  s.width = read.number("width", 0.001, 0.0, 1e3);
  // With MuJoCo's 0 a pair at distance 0 has no contact, and a body that rests falls freely in the first
  // step.
  s.margin = read.number("margin", 1e-6, 0.0, 1e3);
  s.impratio = read.number("impratio", 1.0, 1e-3, 1e6);
  s.noslip_iterations = read.integer("noslip_iterations", 0, 0, 100000);
  s.iterations = read.integer("iterations", 100, 1, 100000);
  s.tolerance = read.number("tolerance", 1e-10, 0.0, 1.0);
  return s;
}

/// MuJoCo would write warnings to MUJOCO_LOG.TXT in the working directory; they are read from mjData instead.
/// An error would end the process.
void install_handlers() {
  mju_user_warning = [](const char*) {};
  mju_user_error = [](const char* message) { throw std::runtime_error(std::string("MuJoCo: ") + message); };
}

struct DeleteModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DeleteData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
struct DeleteVfs {
  void operator()(mjVFS* vfs) const {
    mj_deleteVFS(vfs);
    delete vfs;
  }
};

std::unique_ptr<mjModel, DeleteModel> compile(const std::string& xml) {
  constexpr const char* kFile = "scene.xml";
  const std::unique_ptr<mjVFS, DeleteVfs> vfs(new mjVFS);  // 0.3 MB: too large for the stack of a thread
  mj_defaultVFS(vfs.get());
  mj_makeEmptyFileVFS(vfs.get(), kFile, static_cast<int>(xml.size()));
  std::memcpy(vfs->filedata[mj_findFileVFS(vfs.get(), kFile)], xml.data(), xml.size());
  char error[1000] = "";
  std::unique_ptr<mjModel, DeleteModel> model(mj_loadXML(kFile, vfs.get(), error, sizeof error));
  if (model == nullptr) throw std::runtime_error(std::string("MuJoCo: ") + error);
  return model;
}

Vector<3> from_mujoco(const mjtNum* v) { return {v[0], v[1], v[2]}; }

class MujocoWorld final : public Engine<3> {
 public:
  MujocoWorld(const Scene<3>& scene, const MujocoSettings& settings, Motion motion)
      : scene_(scene), motion_(motion) {
    refuse_moving_half_spaces("MuJoCo", scene_);
    install_handlers();
    model_ = compile(mujoco_xml(scene_, settings, motion));
    data_.reset(mj_makeData(model_.get()));
    body_of_geom_.resize(static_cast<std::size_t>(model_->ngeom));
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) set_state(i);
  }

  StepReport advance(double h) override {
    h_ = h;
    model_->opt.timestep = h;
    mj_step(model_.get(), data_.get());
    if (const StepReport report = warnings(); report.status != StepStatus::solved) return report;
    return {.iterations = data_->solver_iter};
  }

  [[nodiscard]] BodyState<3> body(int index) const override {
    const auto i = static_cast<std::size_t>(index);
    if (scene_.bodies[i].fixed) return {scene_.bodies[i].pose, Twist<3>::Zero()};
    const mjtNum* q = data_->qpos + model_->jnt_qposadr[model_->body_jntadr[body_id_[i]]];
    const mjtNum* v = data_->qvel + model_->jnt_dofadr[model_->body_jntadr[body_id_[i]]];
    BodyState<3> state;
    if (motion_ == Motion::planar) {
      state.pose = {{q[0], q[1], 0},
                    SpatialRotation(Eigen::Quaterniond(Eigen::AngleAxisd(q[2], Vector<3>::UnitZ())))};
      state.velocity << v[0], v[1], 0, 0, 0, v[2];
      return state;
    }
    state.pose = {from_mujoco(q), SpatialRotation(Eigen::Quaterniond(q[3], q[4], q[5], q[6]))};
    // MuJoCo's angular velocity of a free joint is in the body frame.
    state.velocity << from_mujoco(v), state.pose.rotation.matrix() * from_mujoco(v + 3);
    return state;
  }

  [[nodiscard]] MassProperties<3> mass_properties(int index) const override {
    const int id = body_id_[static_cast<std::size_t>(index)];
    const mjtNum* q = model_->body_iquat + 4 * id;
    const Matrix<3> r = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
    return {model_->body_mass[id],
            r * from_mujoco(model_->body_inertia + 3 * id).asDiagonal() * r.transpose()};
  }

  void read_contacts(std::vector<ContactImpulse<3>>& contacts) const override {
    for (int k = 0; k < data_->ncon; ++k) {
      const mjContact& c = data_->contact[k];
      // Rows of the frame: the normal, from geom1 into geom2, and two tangents; the force acts on geom2.
      Matrix<3> frame;
      for (int row = 0; row < 3; ++row) frame.row(row) = from_mujoco(c.frame + 3 * row).transpose();
      mjtNum wrench[6];
      mj_contactForce(model_.get(), data_.get(), k, wrench);
      const Vector<3> normal = frame.row(0).transpose();
      const Vector<3> middle = from_mujoco(c.pos);
      const ContactPlace<3> place{body_of_geom_[static_cast<std::size_t>(c.geom2)],
                                  body_of_geom_[static_cast<std::size_t>(c.geom1)],
                                  middle + c.dist / 2 * normal, middle - c.dist / 2 * normal, normal};
      const Vector<3> force = frame.transpose() * from_mujoco(wrench);
      contacts.push_back(contact_impulse<3>(scene_, place, h_ * force, h_ * wrench[3]));
    }
  }

 private:
  void set_state(std::size_t i) {
    const auto& body = scene_.bodies[i];
    const int geom = mj_name2id(model_.get(), mjOBJ_GEOM, fmt::format("g{}", i).c_str());
    body_of_geom_[static_cast<std::size_t>(geom)] = static_cast<int>(i);
    body_id_.push_back(body.fixed ? 0 : mj_name2id(model_.get(), mjOBJ_BODY, fmt::format("b{}", i).c_str()));
    if (body.fixed) return;
    const int joint = model_->body_jntadr[body_id_[i]];
    mjtNum* q = data_->qpos + model_->jnt_qposadr[joint];
    mjtNum* v = data_->qvel + model_->jnt_dofadr[joint];
    std::copy_n(body.force.data(), 3, data_->xfrc_applied + 6 * body_id_[i]);
    if (motion_ == Motion::planar) {
      const auto& r = body.pose.rotation.matrix();
      const double angle = std::atan2(r(1, 0), r(0, 0));
      std::copy_n(std::array{body.pose.position.x(), body.pose.position.y(), angle}.data(), 3, q);
      std::copy_n(std::array{body.velocity[0], body.velocity[1], body.velocity[5]}.data(), 3, v);
      return;
    }
    const auto& rotation = body.pose.rotation.quaternion();
    std::copy_n(body.pose.position.data(), 3, q);
    std::copy_n(std::array{rotation.w(), rotation.x(), rotation.y(), rotation.z()}.data(), 4, q + 3);
    const Vector<3> rates = body.pose.rotation.matrix().transpose() * body.velocity.tail<3>();
    std::copy_n(body.velocity.data(), 3, v);
    std::copy_n(rates.data(), 3, v + 3);
  }

  /// MuJoCo goes on after these, with contacts dropped or the state reset.
  [[nodiscard]] StepReport warnings() const {
    const auto raised = [&](mjtWarning which) { return data_->warning[which].number > 0; };
    if (raised(mjWARN_BADQPOS) || raised(mjWARN_BADQVEL) || raised(mjWARN_BADQACC)) {
      return {.status = StepStatus::non_finite, .reason = "MuJoCo found its state unusable and reset it"};
    }
    if (raised(mjWARN_CONTACTFULL) || raised(mjWARN_CNSTRFULL)) {
      return {.status = StepStatus::not_converged, .reason = "MuJoCo had no room for a contact"};
    }
    return {};
  }

  const Scene<3> scene_;
  const Motion motion_;
  std::unique_ptr<mjModel, DeleteModel> model_;
  std::unique_ptr<mjData, DeleteData> data_;
  std::vector<int> body_of_geom_;
  std::vector<int> body_id_;  ///< MuJoCo's; 0, the world, for a fixed body
  double h_ = 0;
};

template <Cone cone, Softness softness>
std::unique_ptr<Engine<3>> load(const Scene<3>& scene, OptionReader& read, Motion motion) {
  const MujocoSettings settings = read_settings(read, cone, softness);
  read.finish();
  return std::make_unique<MujocoWorld>(scene, settings, motion);
}

std::string version() { return mj_versionString(); }

constexpr Capabilities kCapabilities{.contact_impulses = true, .torsional_friction = true};
constexpr SpatialEngine kElliptic{"mujoco_elliptic", kCapabilities, kDoublePrecision,
                                  &load<Cone::elliptic, Softness::standard>};
constexpr SpatialEngine kEllipticStiff{"mujoco_elliptic_stiff", kCapabilities, kDoublePrecision,
                                       &load<Cone::elliptic, Softness::stiff>};
constexpr SpatialEngine kPyramidal{"mujoco_pyramidal", kCapabilities, kDoublePrecision,
                                   &load<Cone::pyramidal, Softness::standard>};
constexpr SpatialEngine kPyramidalStiff{"mujoco_pyramidal_stiff", kCapabilities, kDoublePrecision,
                                        &load<Cone::pyramidal, Softness::stiff>};
constexpr const char* kEllipticText = "MuJoCo: soft contacts, elliptic friction cone, default softness";
constexpr const char* kEllipticStiffText =
    "MuJoCo: soft contacts, elliptic friction cone, as stiff as the step allows";
constexpr const char* kPyramidalText = "MuJoCo: soft contacts, friction pyramid, default softness";
constexpr const char* kPyramidalStiffText =
    "MuJoCo: soft contacts, friction pyramid, as stiff as the step allows";

constexpr MethodEntry<2> kPlanar[] = {
    {kElliptic.key, kEllipticText, &make_planar<kElliptic>, &version},
    {kEllipticStiff.key, kEllipticStiffText, &make_planar<kEllipticStiff>, &version},
    {kPyramidal.key, kPyramidalText, &make_planar<kPyramidal>, &version},
    {kPyramidalStiff.key, kPyramidalStiffText, &make_planar<kPyramidalStiff>, &version},
};
constexpr MethodEntry<3> kSpatial[] = {
    {kElliptic.key, kEllipticText, &make_spatial<kElliptic>, &version},
    {kEllipticStiff.key, kEllipticStiffText, &make_spatial<kEllipticStiff>, &version},
    {kPyramidal.key, kPyramidalText, &make_spatial<kPyramidal>, &version},
    {kPyramidalStiff.key, kPyramidalStiffText, &make_spatial<kPyramidalStiff>, &version},
};

}  // namespace

Rows mujoco_rows() { return {kPlanar, kSpatial}; }

}  // namespace touchstone::engines
