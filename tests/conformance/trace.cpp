#include "tests/conformance/trace.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <memory>
#include <stdexcept>

namespace touchstone::conformance {

namespace {

std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), &pclose);
  if (pipe == nullptr) throw std::runtime_error("cannot run " + command);
  std::string text;
  char buffer[4096];
  while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, pipe.get()))
    text.append(buffer, count);
  return text;
}

}  // namespace

template <int Dim>
Scene<Dim> busy_scene() {
  Scene<Dim> scene = on_ground(ball<Dim>("low", 1.02 * up<Dim>()), 0.3);
  scene.bodies[0].velocity[0] = 1.5;
  scene.bodies.push_back(ball<Dim>("high", 2.7 * up<Dim>() + 0.8 * Vector<Dim>::Unit(0), 0.5));
  return scene;
}

template <int Dim>
void append(std::string& text, const Method<Dim>& method) {
  for (const auto& s : method.state()) {
    for (int i = 0; i < Dim; ++i) text += fmt::format("{:a} ", s.pose.position[i]);
    const auto& r = s.pose.rotation.matrix();
    for (int i = 0; i < Dim * Dim; ++i) text += fmt::format("{:a} ", r(i / Dim, i % Dim));
    for (int i = 0; i < Dimension<Dim>::velocity; ++i) text += fmt::format("{:a} ", s.velocity[i]);
  }
  for (const auto& c : method.contacts()) text += fmt::format("p{:a} ", c.normal_impulse);
  text += '\n';
}

template <int Dim>
std::string trace(const MethodEntry<Dim>& entry) {
  std::string text;
  const auto method = entry.make(busy_scene<Dim>(), {});
  for (int k = 0; k < kTraceSteps; ++k) {
    advance(*method, kStep, 1);
    append(text, *method);
  }
  return text;
}

template <int Dim>
std::string trace_of_fresh_process(std::string_view key) {
  return output_of(fmt::format("'{}' --trace {} {}", testing::internal::GetArgvs()[0], Dim, key));
}

template Scene<2> busy_scene();
template Scene<3> busy_scene();
template void append(std::string&, const Method<2>&);
template void append(std::string&, const Method<3>&);
template std::string trace(const MethodEntry<2>&);
template std::string trace(const MethodEntry<3>&);
template std::string trace_of_fresh_process<2>(std::string_view);
template std::string trace_of_fresh_process<3>(std::string_view);

}  // namespace touchstone::conformance
