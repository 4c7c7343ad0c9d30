#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "baselines/engines/bullet_float_messages.h"
#include "core/model/errors.h"

/// Bullet's single-precision build in a process of its own: loads the scene that comes on standard input, a
/// socket, and answers each step with the state. Ends when the other end does.
namespace touchstone::engines {

namespace {

std::vector<BodyState<3>> state_of(const Engine<3>& world, std::size_t bodies) {
  std::vector<BodyState<3>> state;
  for (std::size_t i = 0; i < bodies; ++i) state.push_back(world.body(static_cast<int>(i)));
  return state;
}

template <typename Message>
void answer(Message message) {
  WireWriter reply;
  transfer(reply, message);
  send_message(STDIN_FILENO, reply.bytes());
}

/// @returns the world, or null if it was refused
std::unique_ptr<Engine<3>> load(const BulletFloatLoad& request) {
  std::unique_ptr<Engine<3>> world;
  BulletFloatLoaded loaded;
  try {
    world = make_bullet_world(request.scene, request.settings, request.motion);
    const auto& bodies = request.scene.bodies;
    loaded.state = state_of(*world, bodies.size());
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      loaded.mass_properties.push_back(bodies[i].fixed ? MassProperties<3>{}
                                                       : world->mass_properties(static_cast<int>(i)));
    }
  } catch (const Unsupported& refusal) {
    loaded.refusal = refusal.what();
  }
  answer(std::move(loaded));
  return world;
}

void serve() {
  BulletFloatLoad request;
  const std::string bytes = receive_message(STDIN_FILENO);
  WireReader reader(bytes);
  transfer(reader, request);
  const auto world = load(request);
  while (world != nullptr) {
    const std::string step = receive_message(STDIN_FILENO);
    WireReader step_reader(step);
    double h = 0;
    transfer(step_reader, h);
    static_cast<void>(world->advance(h));
    BulletFloatStepped stepped;
    stepped.state = state_of(*world, request.scene.bodies.size());
    world->read_contacts(stepped.contacts);
    answer(std::move(stepped));
  }
}

}  // namespace

}  // namespace touchstone::engines

/// With the argument `version` prints the library's and ends.
int main(int argc, char**) {
  if (argc > 1) {
    std::puts(touchstone::engines::bullet_version().c_str());
    return 0;
  }
  // While a step takes for ever nobody looks whether the other end is still there.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  try {
    touchstone::engines::serve();
  } catch (const std::exception&) {
    return 0;  // the other end has gone, as it does when it is done
  }
  return 0;
}
