#include "baselines/engines/bullet_float.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <pthread.h>

#include <filesystem>
#include <stdexcept>

#include "baselines/engines/bullet_float_module.h"
#include "core/model/errors.h"

namespace touchstone::engines {

namespace {

/// The C library of the module's namespace is not told of a fork, as the program's own is: a lock of its that
/// another thread holds then would stay so in the child. So a fork waits until nobody is in the module.
class ForkGate {
 public:
  ForkGate() { pthread_rwlock_rdlock(&lock_); }
  ~ForkGate() { pthread_rwlock_unlock(&lock_); }
  ForkGate(const ForkGate&) = delete;
  ForkGate& operator=(const ForkGate&) = delete;

  static int install() {
    return pthread_atfork([] { pthread_rwlock_wrlock(&lock_); }, [] { pthread_rwlock_unlock(&lock_); },
                          // Its holder has another thread id in the child, which cannot unlock it.
                          [] { lock_ = PTHREAD_RWLOCK_WRITER_NONRECURSIVE_INITIALIZER_NP; });
  }

 private:
  // Forks come before further calls, or steps of several threads could keep one waiting for ever.
  static inline pthread_rwlock_t lock_ = PTHREAD_RWLOCK_WRITER_NONRECURSIVE_INITIALIZER_NP;
};
[[maybe_unused]] const int gate_installed = ForkGate::install();

/// The module beside this program in the folder of the build, so that a build that was moved uses its own; or
/// where the build put it.
std::filesystem::path module_path() {
  namespace fs = std::filesystem;
  std::error_code unreadable;
  fs::path folder = fs::read_symlink("/proc/self/exe", unreadable).parent_path();
  const fs::path in_build = TOUCHSTONE_BULLET_FLOAT_IN_BUILD;
  for (; folder.has_relative_path(); folder = folder.parent_path()) {
    std::error_code missing;
    if (fs::exists(folder / in_build, missing)) return folder / in_build;
  }
  return TOUCHSTONE_BULLET_FLOAT_MODULE;
}

/// Loaded at the first call, once: glibc has room for 16 namespaces in a process. It stays to the end.
const BulletFloatModule& module() {
  static const BulletFloatModule& loaded = []() -> const BulletFloatModule& {
    const std::string path = module_path();
    void* handle = dlmopen(LM_ID_NEWLM, path.c_str(), RTLD_NOW | RTLD_LOCAL);
    void* entry = handle == nullptr ? nullptr : dlsym(handle, "touchstone_bullet_float_module");
    if (entry == nullptr)
      throw IoError(fmt::format("Bullet's single-precision module cannot be loaded: {}", dlerror()));
    return *reinterpret_cast<decltype(&touchstone_bullet_float_module)>(entry)();
  }();
  return loaded;
}

void rethrow(const BulletFloatFailure& failure) {
  if (failure.kind == BulletFloatFailure::Kind::unsupported) throw Unsupported(failure.what);
  if (failure.kind == BulletFloatFailure::Kind::failed) throw std::runtime_error(failure.what);
}

class BulletFloatWorld final : public Engine<3> {
 public:
  BulletFloatWorld(const Scene<3>& scene, const BulletSettings& settings, Motion motion) {
    const ForkGate gate;
    BulletFloatFailure failure;
    world_ = module().load(scene, settings, motion, failure);
    rethrow(failure);
  }
  ~BulletFloatWorld() override {
    const ForkGate gate;
    module().unload(world_);
  }

  StepReport advance(double h) override {
    const ForkGate gate;
    BulletFloatFailure failure;
    const StepReport report = module().advance(world_, h, failure);
    rethrow(failure);
    return report;
  }
  [[nodiscard]] BodyState<3> body(int index) const override {
    const ForkGate gate;
    BodyState<3> state;
    module().body(world_, index, state);
    return state;
  }
  [[nodiscard]] MassProperties<3> mass_properties(int index) const override {
    const ForkGate gate;
    MassProperties<3> properties;
    module().mass_properties(world_, index, properties);
    return properties;
  }
  void read_contacts(std::vector<ContactImpulse<3>>& contacts) const override {
    const ForkGate gate;
    BulletFloatFailure failure;
    const auto found = module().contacts(world_, failure);
    rethrow(failure);
    contacts.insert(contacts.end(), found.begin(), found.end());
  }

 private:
  void* world_ = nullptr;
};

}  // namespace

std::string bullet_float_version() {
  const ForkGate gate;
  BulletFloatFailure failure;
  const char* text = module().version(failure);
  rethrow(failure);
  return text;
}

std::unique_ptr<Engine<3>> make_bullet_float_world(const Scene<3>& scene, const BulletSettings& settings,
                                                   Motion motion) {
  return std::make_unique<BulletFloatWorld>(scene, settings, motion);
}

}  // namespace touchstone::engines
