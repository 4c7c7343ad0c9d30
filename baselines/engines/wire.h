#pragma once

#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "baselines/engines/engine.h"

/// What goes between an engine in a process of its own and its proxy: both ends are of one build and on one
/// machine, so values travel as their bytes. One `transfer` a type serves for both directions.
namespace touchstone::engines {

class WireWriter {
 public:
  template <typename T>
  void raw(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

class WireReader {
 public:
  explicit WireReader(std::string_view bytes) : bytes_(bytes) {}

  /// @throws std::runtime_error if the message ends before
  template <typename T>
  void raw(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (bytes_.size() < sizeof value)
      throw std::runtime_error("a message of an engine's process was cut off");
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_.remove_prefix(sizeof value);
  }

 private:
  std::string_view bytes_;
};

template <typename Wire, typename T>
requires std::is_arithmetic_v<T> || std::is_enum_v<T>
void transfer(Wire& wire, T& value) { wire.raw(value); }

template <typename Wire, int Rows, int Cols>
void transfer(Wire& wire, Eigen::Matrix<double, Rows, Cols>& matrix) {
  static_assert(Rows > 0 && Cols > 0);
  for (double& value : matrix.reshaped()) wire.raw(value);
}

template <typename Wire>
void transfer(Wire& wire, std::string& text);
template <typename Wire, typename T>
void transfer(Wire& wire, std::vector<T>& values);

template <typename Wire>
void transfer(Wire& wire, Pose<3>& pose) {
  Eigen::Quaterniond q = pose.rotation.quaternion();
  transfer(wire, pose.position);
  for (double& value : q.coeffs()) wire.raw(value);
  if constexpr (std::is_same_v<Wire, WireReader>) pose.rotation = SpatialRotation(q);
}

template <typename Wire>
void transfer(Wire& wire, BodyState<3>& state) {
  transfer(wire, state.pose);
  transfer(wire, state.velocity);
}

template <typename Wire>
void transfer(Wire& wire, ContactImpulse<3>& c) {
  transfer(wire, c.body_a);
  transfer(wire, c.body_b);
  transfer(wire, c.point_a);
  transfer(wire, c.point_b);
  transfer(wire, c.normal);
  transfer(wire, c.tangents);
  transfer(wire, c.normal_impulse);
  transfer(wire, c.friction_impulse);
}

template <typename Wire>
void transfer(Wire& wire, MassProperties<3>& properties) {
  transfer(wire, properties.mass);
  transfer(wire, properties.inertia);
}

template <typename Wire>
void transfer(Wire& wire, ContactLaw<3>& law) {
  for (double* value : {&law.mu, &law.e_t, &law.e_o, &law.e_r, &law.restitution}) wire.raw(*value);
  transfer(wire, law.tangent);
}

template <typename Wire>
void transfer(Wire& wire, PairLaw<3>& pair) {
  transfer(wire, pair.body_a);
  transfer(wire, pair.body_b);
  transfer(wire, pair.law);
}

// The members of each geometry. Those that no engine in a process has are not sent; a server refuses them by
// name.
template <typename Wire>
void transfer(Wire& wire, Sphere<3>& s) {
  transfer(wire, s.radius);
}
template <typename Wire>
void transfer(Wire& wire, HalfSpace<3>& s) {
  transfer(wire, s.normal);
  transfer(wire, s.offset);
}
template <typename Wire>
void transfer(Wire& wire, Box<3>& s) {
  transfer(wire, s.half_extents);
}
template <typename Wire>
void transfer(Wire& wire, Polytope<3>& s) {
  transfer(wire, s.normals);
  transfer(wire, s.offsets);
  transfer(wire, s.vertices);
}
template <typename Wire>
void transfer(Wire& wire, Cylinder& s) {
  transfer(wire, s.radius);
  transfer(wire, s.half_height);
}
template <typename Wire>
void transfer(Wire& wire, Capsule& s) {
  transfer(wire, s.radius);
  transfer(wire, s.half_height);
}
template <typename Wire>
void transfer(Wire& wire, Cone& s) {
  transfer(wire, s.radius);
  transfer(wire, s.height);
}
template <typename Wire>
void transfer(Wire& wire, Ellipsoid<3>& s) {
  transfer(wire, s.semi_axes);
}
template <typename Wire>
void transfer(Wire& wire, Superellipsoid<3>& s) {
  transfer(wire, s.semi_axes);
  transfer(wire, s.exponents);
}
template <typename Wire>
void transfer(Wire& wire, Shape<3>& shape);
template <typename Wire>
void transfer(Wire& wire, Intersection<3>& s) {
  transfer(wire, s.parts);
}

/// Makes `geometry` hold its alternative number `index`.
template <std::size_t... I>
void emplace_alternative(Geometry<3>::Variant& geometry, std::size_t index, std::index_sequence<I...>) {
  static_cast<void>(((index == I ? (geometry.emplace<I>(), true) : false) || ...));
}

template <typename Wire>
void transfer(Wire& wire, Shape<3>& shape) {
  std::size_t index = shape.geometry.index();
  transfer(wire, index);
  if constexpr (std::is_same_v<Wire, WireReader>) {
    constexpr std::size_t kCount = std::variant_size_v<Geometry<3>::Variant>;
    if (index >= kCount) throw std::runtime_error("a message of an engine's process names no shape");
    emplace_alternative(shape.geometry, index, std::make_index_sequence<kCount>());
  }
  std::visit([&](auto& geometry) { transfer(wire, geometry); }, shape.geometry);
  transfer(wire, shape.placement);
}

template <typename Wire>
void transfer(Wire& wire, Body<3>& body) {
  transfer(wire, body.name);
  transfer(wire, body.fixed);
  transfer(wire, body.mass);
  transfer(wire, body.inertia);
  transfer(wire, body.pose);
  transfer(wire, body.velocity);
  transfer(wire, body.force);
  transfer(wire, body.shape);
}

/// Without joints, which a proxy has refused before.
template <typename Wire>
void transfer(Wire& wire, Scene<3>& scene) {
  transfer(wire, scene.gravity);
  transfer(wire, scene.contact_law);
  transfer(wire, scene.pair_laws);
  transfer(wire, scene.bodies);
}

template <typename Wire, typename Sequence>
void transfer_size(Wire& wire, Sequence& sequence) {
  std::size_t size = sequence.size();
  wire.raw(size);
  if constexpr (std::is_same_v<Wire, WireReader>) sequence.resize(size);
}
template <typename Wire>
void transfer(Wire& wire, std::string& text) {
  transfer_size(wire, text);
  for (char& c : text) wire.raw(c);
}
template <typename Wire, typename T>
void transfer(Wire& wire, std::vector<T>& values) {
  transfer_size(wire, values);
  for (T& value : values) transfer(wire, value);
}

/// Sends or receives one message, its length first. @throws std::runtime_error if the other end has gone
void send_message(int fd, const std::string& bytes);
std::string receive_message(int fd);

}  // namespace touchstone::engines
