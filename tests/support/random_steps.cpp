#include "tests/support/random_steps.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <set>

#include "core/contact/closest_points.h"
#include "core/model/errors.h"
#include "core/surfaces/convex_surface.h"

namespace touchstone::random_steps {

namespace {

/// SplitMix64 (Steele, Lea & Flood 2014): the standard library's distributions differ between libraries.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// In [0, 1).
  double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  double real(double low, double high) { return low + (high - low) * unit(); }
  /// Evenly over the decades from 10^low to 10^high.
  double decades(double low, double high) { return std::pow(10, real(low, high)); }
  int integer(int low, int high) { return low + static_cast<int>(unit() * (high - low + 1)); }
  bool chance(double p) { return unit() < p; }
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - unit()));
    return radius * std::cos(2 * std::numbers::pi * unit());
  }
  /// A vector of any direction, `low` to `high` long.
  template <int Dim>
  Vector<Dim> vector(double low, double high) {
    const double length = real(low, high);
    return length * direction<Dim>();
  }
  template <int Dim>
  Vector<Dim> direction() {
    Vector<Dim> v;
    do {
      for (int k = 0; k < Dim; ++k) v[k] = normal();
    } while (!(v.norm() > 1e-3));
    return v.normalized();
  }

 private:
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

template <int Dim>
Vector<Dim> extents(Random& random, double size) {
  Vector<Dim> v;
  for (int k = 0; k < Dim; ++k) v[k] = size * random.real(0.3, 1);
  return v;
}

template <int Dim>
Polytope<Dim> random_polytope(Random& random, double size) {
  for (;;) {
    std::vector<Vector<Dim>> points;
    for (int k = random.integer(Dim + 2, 10); k > 0; --k)
      points.push_back(random.vector<Dim>(0.6 * size, size));
    try {
      return polytope_from_vertices<Dim>(points, "random");
    } catch (const InputError&) {  // too flat: another
    }
  }
}

/// Two balls, a ball and a box, or a ball and a half-space that share a solid around the origin.
template <int Dim>
Intersection<Dim> random_intersection(Random& random, double size) {
  const Vector<Dim> off = random.vector<Dim>(0.2 * size, 0.6 * size);
  Intersection<Dim> result;
  result.parts.push_back({Sphere<Dim>{size}, {off, {}}});
  switch (random.integer(0, 2)) {
    case 0:
      result.parts.push_back({Sphere<Dim>{size}, {-off, {}}});
      break;
    case 1:
      result.parts.push_back({Box<Dim>{extents<Dim>(random, size)}, {}});
      break;
    default:
      result.parts.push_back({HalfSpace<Dim>{random.direction<Dim>(), size * random.real(0, 0.3)}, {}});
  }
  return result;
}

template <int Dim>
typename Geometry<Dim>::Variant random_geometry(Random& random, double size) {
  switch (random.integer(0, Dim == 3 ? 8 : 6)) {
    case 0:
      return Sphere<Dim>{size};
    case 1:
      return Ellipsoid<Dim>{extents<Dim>(random, size)};
    case 2: {
      Vector<Dim> exponents;
      for (int k = 0; k < Dim; ++k) exponents[k] = random.real(2, 6);
      return Superellipsoid<Dim>{extents<Dim>(random, size), exponents};
    }
    case 3:
      return Box<Dim>{extents<Dim>(random, size)};
    case 4:
      return random_polytope<Dim>(random, size);
    case 5:
      return random_intersection<Dim>(random, size);
    default:
      break;
  }
  if constexpr (Dim == 2) {
    return RegularPolygon{random.integer(3, 12), size};
  } else {
    switch (random.integer(0, 2)) {
      case 0:
        return Cylinder{size * random.real(0.3, 1), size * random.real(0.3, 1)};
      case 1:
        return Cone{size * random.real(0.3, 1), size * random.real(0.5, 2)};
      default:
        return Capsule{size * random.real(0.2, 0.7), size * random.real(0.2, 1)};
    }
  }
}

PlanarRotation any_rotation(Random& random, Dimension<2>) {
  return PlanarRotation(random.real(0, 2 * std::numbers::pi));
}
SpatialRotation any_rotation(Random& random, Dimension<3>) {
  const Vector<3> axis = random.direction<3>();
  return SpatialRotation(exp_rotation(random.real(0, std::numbers::pi) * axis));
}

Angular<2> small_turn(Random& random, double size, Dimension<2>) {
  return Angular<2>(size * (random.chance(0.5) ? 1 : -1));
}
Angular<3> small_turn(Random& random, double size, Dimension<3>) { return size * random.direction<3>(); }

/// A multiple of a right angle, so that boxes and cylinders stand square to each other, and perhaps a bit
/// off.
template <int Dim>
Rotation<Dim> random_rotation(Random& random) {
  if (random.chance(0.5)) return any_rotation(random, Dimension<Dim>{});
  Rotation<Dim> rotation;
  Angular<Dim> quarter = Angular<Dim>::Zero();
  quarter[random.integer(0, Dimension<Dim>::angular - 1)] = random.integer(0, 3) * std::numbers::pi / 2;
  rotation = rotation.turned(quarter);
  if (random.chance(0.6))
    rotation = rotation.turned(small_turn(random, random.decades(-12, -2), Dimension<Dim>{}));
  return rotation;
}

Inertia<2> random_inertia(Random& random, double scale, Dimension<2>) {
  return Inertia<2>(scale * random.real(0.2, 1));
}
/// Principal moments of some solid, which fulfil the triangle inequality.
Inertia<3> random_inertia(Random& random, double scale, Dimension<3>) {
  const Vector<3> squares = extents<3>(random, 1).cwiseAbs2();
  return (0.5 * scale * Vector<3>::Constant(squares.sum()) - 0.5 * scale * squares).asDiagonal();
}

template <int Dim>
class Maker {
 public:
  explicit Maker(std::uint64_t seed) : random_(seed) {}

  RandomStep<Dim> make() {
    step_.h = random_.decades(-4, -1.3);
    add_law();
    const double g = random_.chance(0.1) ? 0.0 : random_.real(1, 20);
    step_.scene.gravity = -g * Vector<Dim>::Unit(Dim - 1);
    speed_ = random_.chance(0.2) ? 0.0 : random_.decades(-2, 1);
    if (random_.chance(0.7)) add_ground();
    const int moving = random_.integer(1, 8);
    for (int i = 0; i < moving; ++i) add_body(false);
    for (int i = random_.chance(0.3) ? random_.integer(1, 2) : 0; i > 0; --i) add_body(true);
    return std::move(step_);
  }

 private:
  void add_law() {
    ContactLaw<Dim>& law = step_.scene.contact_law;
    law.mu = random_.chance(0.15) ? 0.0 : random_.real(0, 2);
    if (Dim == 2) return;
    if (random_.chance(0.3)) law.e_o = random_.real(0.2, 1.5);
    if (random_.chance(0.4)) law.e_r = random_.real(0.01, 0.5);
    law.tangent = random_.direction<Dim>();
  }

  void add_ground() {
    Body<Dim> ground{.name = "ground", .fixed = true};
    Vector<Dim> tilt = Vector<Dim>::Zero();
    if (random_.chance(0.5)) tilt = 0.3 * random_.direction<Dim>();
    ground.shape.geometry = HalfSpace<Dim>{(Vector<Dim>::Unit(Dim - 1) + tilt).normalized(), 0.0};
    append(std::move(ground));
  }

  void append(Body<Dim> body) {
    surfaces_.push_back(make_surface(body.shape));
    step_.scene.bodies.push_back(std::move(body));
  }

  /// Makes a body and puts it against one that is there, at a small gap; leaves it out if it fits nowhere.
  void add_body(bool fixed) {
    constexpr int kTries = 20;
    const double size = random_.decades(-0.5, 0.5);
    Body<Dim> body;
    body.name = fmt::format("body {}", step_.scene.bodies.size());
    body.fixed = fixed;
    body.shape.geometry = random_geometry<Dim>(random_, size);
    if (random_.chance(0.2)) body.shape.placement.position = 0.3 * size * random_.direction<Dim>();
    if (!fixed) {
      body.mass = random_.decades(-2, 2);
      body.inertia = random_inertia(random_, body.mass * size * size, Dimension<Dim>{});
      for (int k = 0; k < Dimension<Dim>::velocity; ++k)
        body.velocity[k] = speed_ * random_.normal() / (k < Dim ? 1 : size);
      if (random_.chance(0.1)) body.force = random_.vector<Dim>(0, 20 * body.mass);
    }
    const auto surface = make_surface(body.shape);
    for (int k = 0; k < kTries; ++k) {
      body.pose.rotation = random_rotation<Dim>(random_);
      body.pose.position = 30 * random_.direction<Dim>();
      body.pose.position[Dim - 1] = std::abs(body.pose.position[Dim - 1]);
      if (step_.scene.bodies.empty() || place(body, *surface, size)) return append(std::move(body));
    }
  }

  double random_gap(double size) {
    switch (random_.integer(0, 3)) {
      case 0:
        return 0.0;
      case 1:
        return size * random_.decades(-14, -3);
      default:
        return random_.unit() * step_.h * (speed_ + 10 * step_.h);
    }
  }

  /// Moves the body along the common normal up to the gap, which leaves the closest points the closest ones.
  bool place(Body<Dim>& body, const ConvexSurface<Dim>& surface, double size) {
    const auto target =
        static_cast<std::size_t>(random_.integer(0, static_cast<int>(step_.scene.bodies.size()) - 1));
    const auto closest =
        closest_points(surface, body.pose, *surfaces_[target], step_.scene.bodies[target].pose);
    if (!closest.converged || !(closest.gap > 0)) return false;
    body.pose.position += (random_gap(size) - closest.gap) * closest.normal;
    const double rounding = 1e-13 * size;
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
      const auto other = closest_points(surface, body.pose, *surfaces_[i], step_.scene.bodies[i].pose);
      if (!other.converged || other.gap < -rounding) return false;
    }
    return true;
  }

  Random random_;
  RandomStep<Dim> step_;
  double speed_ = 0.0;  ///< scale of velocities [m/s]
  std::vector<std::shared_ptr<const ConvexSurface<Dim>>> surfaces_;
};

// --- as text

template <int N>
std::string list(const Eigen::Matrix<double, N, 1>& v) {
  return fmt::format("[{}]", fmt::join(v.data(), v.data() + v.size(), ", "));
}

std::string text(const PlanarRotation& r) { return fmt::format("{}", r.angle()); }
std::string text(const SpatialRotation& r) {
  const Eigen::Quaterniond& q = r.quaternion();
  return fmt::format("[{}, {}, {}, {}]", q.w(), q.x(), q.y(), q.z());
}

template <int Dim>
std::string text(const Shape<Dim>& shape);

template <int Dim>
struct GeometryText {
  std::string operator()(const Sphere<Dim>& s) const { return fmt::format("radius = {}", s.radius); }
  std::string operator()(const Ellipsoid<Dim>& s) const { return "semi_axes = " + list<Dim>(s.semi_axes); }
  std::string operator()(const Superellipsoid<Dim>& s) const {
    return fmt::format("semi_axes = {}, exponents = {}", list<Dim>(s.semi_axes), list<Dim>(s.exponents));
  }
  std::string operator()(const HalfSpace<Dim>& s) const {
    return fmt::format("normal = {}, offset = {}", list<Dim>(s.normal), s.offset);
  }
  std::string operator()(const Box<Dim>& s) const { return "half_extents = " + list<Dim>(s.half_extents); }
  std::string operator()(const Polytope<Dim>& s) const {
    std::vector<std::string> vertices;
    for (const auto& v : s.vertices) vertices.push_back(list<Dim>(v));
    return fmt::format("vertices = [{}]", fmt::join(vertices, ", "));
  }
  std::string operator()(const Cylinder& s) const {
    return fmt::format("radius = {}, half_height = {}", s.radius, s.half_height);
  }
  std::string operator()(const Cone& s) const {
    return fmt::format("radius = {}, height = {}", s.radius, s.height);
  }
  std::string operator()(const Capsule& s) const {
    return fmt::format("radius = {}, half_height = {}", s.radius, s.half_height);
  }
  std::string operator()(const RegularPolygon& s) const {
    return fmt::format("edges = {}, circumradius = {}", s.edges, s.circumradius);
  }
  std::string operator()(const Intersection<Dim>& s) const {
    std::vector<std::string> parts;
    for (const auto& part : s.parts) parts.push_back(text(part));
    return fmt::format("parts = [{}]", fmt::join(parts, ", "));
  }
};

template <int Dim>
std::string text(const Shape<Dim>& shape) {
  return fmt::format("{{ type = \"{}\", {}, center = {}, rotation = {} }}", shape_name(shape),
                     std::visit(GeometryText<Dim>{}, shape.geometry), list<Dim>(shape.placement.position),
                     text(shape.placement.rotation));
}

std::string inertia_text(const Inertia<2>& i) { return fmt::format("{}", i(0, 0)); }
std::string inertia_text(const Inertia<3>& i) { return list<3>(i.diagonal()); }

std::string angular_text(const Angular<2>& w) { return fmt::format("{}", w[0]); }
std::string angular_text(const Angular<3>& w) { return list<3>(w); }

template <int Dim>
std::string text(const Body<Dim>& body) {
  std::string result = fmt::format("[[body]]\nname = \"{}\"\n", body.name);
  result += fmt::format("position = {}\norientation = {}\n", list<Dim>(body.pose.position),
                        text(body.pose.rotation));
  if (body.fixed) {
    result += "fixed = true\n";
  } else {
    result +=
        fmt::format("mass = {}\ninertia = {}\nvelocity = {}\nangular_velocity = {}\nforce = {}\n", body.mass,
                    inertia_text(body.inertia), list<Dim>(Vector<Dim>(body.velocity.template head<Dim>())),
                    angular_text(Angular<Dim>(body.velocity.template tail<Dimension<Dim>::angular>())),
                    list<Dim>(body.force));
  }
  return result + fmt::format("shape = {}\n\n", text(body.shape));
}

}  // namespace

template <int Dim>
RandomStep<Dim> random_step(std::uint64_t seed) {
  return Maker<Dim>(seed).make();
}

template <int Dim>
std::string write_scene(const Scene<Dim>& scene) {
  const ContactLaw<Dim>& law = scene.contact_law;
  std::string result = fmt::format("dimension = {}\ngravity = {}\n\n[friction]\nmu = {}\ne_t = {}\n", Dim,
                                   list<Dim>(scene.gravity), law.mu, law.e_t);
  if (Dim == 3)
    result += fmt::format("e_o = {}\ne_r = {}\ntangent = {}\n", law.e_o, law.e_r, list<Dim>(law.tangent));
  result += '\n';
  for (const auto& body : scene.bodies) result += text(body);
  return result;
}

template <int Dim>
std::string shapes_of(const Scene<Dim>& scene) {
  std::set<std::string> names;
  for (const auto& body : scene.bodies) names.insert(shape_name(body.shape));
  return fmt::format("{}", fmt::join(names, ","));
}

template RandomStep<2> random_step(std::uint64_t);
template RandomStep<3> random_step(std::uint64_t);
template std::string write_scene(const Scene<2>&);
template std::string write_scene(const Scene<3>&);
template std::string shapes_of(const Scene<2>&);
template std::string shapes_of(const Scene<3>&);

}  // namespace touchstone::random_steps
