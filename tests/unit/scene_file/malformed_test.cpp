// Everything that can be wrong with a scene file, one thing at a time: each is an InputError that names file,
// line, column, key, value and what is allowed.

#include <gtest/gtest.h>

#include "core/model/errors.h"
#include "experiments/scene_file/scene_file.h"

namespace touchstone::scene_file {
namespace {

const char* const kSpatial = R"(dimension = 3
gravity = [0, 0, -9.81]
[friction]
mu = 0.2
e_t = 1.0
restitution = 0.0
tangent = [1, 0, 0]
[[body]]
name = "ball"
mass = 1.0
inertia = [0.4, 0.4, 0.4]
position = [0, 0, 1]
orientation = [1, 0, 0, 0]
velocity = [0, 0, 0]
shape = { type = "ellipsoid", semi_axes = [1, 1, 1] }
[[body]]
name = "ground"
fixed = true
shape = { type = "half_space", normal = [0, 0, 1], offset = 0 }
[[body]]
name = "block"
mass = 1.0
inertia = [1, 1, 1]
position = [5, 0, 1]
shape = { type = "box", half_extents = [1, 1, 1] }
[[pair]]
bodies = ["ball", "ground"]
mu = 0.3
[[joint]]
type = "hinge"
bodies = ["ball", "block"]
anchor = [2, 0, 1]
axis = [0, 1, 0]
)";

const char* const kPlanar = R"(dimension = 2
gravity = [0, -9.81]
[[body]]
name = "disc"
mass = 1.0
inertia = 0.5
position = [0, 1]
angular_velocity = 3
shape = { type = "disc", radius = 1 }
[[body]]
name = "ground"
fixed = true
shape = { type = "half_space", normal = [0, 1], offset = 0 }
[[joint]]
type = "slider"
bodies = ["ground", "disc"]
anchor = [0, 1]
axis = [1, 0]
)";

struct Fault {
  const char* name;
  const char* base;
  const char* old;  ///< its first occurrence is replaced; at the end if it is empty
  const char* now;
  const char* message;  ///< how it must begin, after the file's name
};

std::string with(const Fault& fault) {
  std::string text = fault.base;
  const std::string old = fault.old;
  const std::size_t at = old.empty() ? text.size() : text.find(old);
  return text.replace(at, old.size(), fault.now);
}

class Malformed : public testing::TestWithParam<Fault> {};

TEST_P(Malformed, IsRefusedWithPlaceKeyValueAndWhatIsAllowed) {
  const Fault& fault = GetParam();
  const std::string text = with(fault);
  ASSERT_NE(text, fault.base) << "nothing is changed";
  try {
    parse_scene(text, "bad.toml");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with("bad.toml:" + std::string(fault.message))) << message;
    EXPECT_NE(message.find(", allowed: "), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST(MalformedBases, TheScenesWithoutAFaultAreSound) {
  EXPECT_NO_THROW(parse_scene(kSpatial, "good.toml"));
  EXPECT_NO_THROW(parse_scene(kPlanar, "good.toml"));
}

const Fault kFaults[] = {
    // Not TOML.
    {"Syntax", kSpatial, "[friction]", "[friction", "3:10: got Error while parsing table header"},
    {"KeyTwice", kSpatial, "mass = 1.0", "mass = 1.0\nmass = 2.0",
     "11:8: got Error while parsing key-value pair"},
    {"Empty", kSpatial, kSpatial, "", "1:1: dimension: got nothing, but it is required, allowed: 2 or 3"},
    // Missing.
    {"NoDimension", kSpatial, "dimension = 3", "", "1:1: dimension: got nothing"},
    {"NoGravity", kSpatial, "gravity = [0, 0, -9.81]", "", "1:1: gravity: got nothing"},
    {"NoBody", kPlanar, kPlanar, "dimension = 2\ngravity = [0, 0]", "1:1: body: got nothing"},
    {"NoBodies", kPlanar, kPlanar, "dimension = 2\ngravity = [0, 0]\nbody = []", "3:8: body: got none"},
    {"NoName", kSpatial, "name = \"ball\"", "", "8:1: body 1 name: got nothing"},
    {"NoMass", kSpatial, "mass = 1.0", "",
     "8:1: body 'ball' mass: got nothing, but it is required, allowed: a number > 0 [kg]"},
    {"NoInertia", kSpatial, "inertia = [0.4, 0.4, 0.4]", "", "8:1: body 'ball' inertia: got nothing"},
    {"NoShape", kSpatial, "shape = { type = \"box\", half_extents = [1, 1, 1] }", "",
     "20:1: body 'block' shape: got nothing"},
    {"NoType", kSpatial, "type = \"ellipsoid\", ", "", "15:9: body 'ball' shape.type: got nothing"},
    {"NoSemiAxes", kSpatial, ", semi_axes = [1, 1, 1]", "", "15:9: body 'ball' shape.semi_axes: got nothing"},
    {"NoOffset", kSpatial, ", offset = 0", "", "19:9: body 'ground' shape.offset: got nothing"},
    {"NoMu", kSpatial, "mu = 0.2\n", "", "3:1: friction.mu: got nothing"},
    {"NoBodiesOfAPair", kSpatial, "bodies = [\"ball\", \"ground\"]", "", "26:1: pair 1 bodies: got nothing"},
    {"NoTypeOfAJoint", kSpatial, "type = \"hinge\"", "", "29:1: joint 1 type: got nothing"},
    {"NoAnchor", kSpatial, "anchor = [2, 0, 1]", "", "29:1: joint 1 anchor: got nothing"},
    {"NoAxis", kSpatial, "axis = [0, 1, 0]", "", "29:1: joint 1 axis: got nothing"},
    // Of another type.
    {"DimensionIsText", kSpatial, "dimension = 3", "dimension = \"3\"",
     "1:13: dimension: got '3', allowed: an integer"},
    {"DimensionIsFloat", kSpatial, "dimension = 3", "dimension = 3.0",
     "1:13: dimension: got 3, allowed: an integer"},
    {"GravityIsNumber", kSpatial, "[0, 0, -9.81]", "-9.81",
     "2:11: gravity: got -9.81, allowed: a list of numbers"},
    {"MassIsText", kSpatial, "mass = 1.0", "mass = \"heavy\"",
     "10:8: body 'ball' mass: got 'heavy', allowed: a number"},
    {"MassIsFlag", kSpatial, "mass = 1.0", "mass = true",
     "10:8: body 'ball' mass: got true, allowed: a number"},
    {"MassIsDate", kSpatial, "mass = 1.0", "mass = 2007-04-10",
     "10:8: body 'ball' mass: got a date or a time"},
    {"NameIsNumber", kSpatial, "name = \"ball\"", "name = 7", "9:8: body 1 name: got 7, allowed: a text"},
    {"NameIsEmpty", kSpatial, "name = \"ball\"", "name = \"\"", "9:8: body 1 name: got '', allowed: a text"},
    {"FixedIsText", kSpatial, "fixed = true", "fixed = \"yes\"",
     "18:9: body 'ground' fixed: got 'yes', allowed: true or false"},
    {"ShapeIsText", kSpatial, "{ type = \"ellipsoid\", semi_axes = [1, 1, 1] }", "\"sphere\"",
     "15:9: body 'ball' shape: got 'sphere', allowed: a table"},
    {"BodyIsTable", kPlanar, kPlanar, "dimension = 2\ngravity = [0, 0]\n[body]\nname = \"a\"",
     "3:1: body: got a table, allowed: a list"},
    {"FrictionIsNumber", kPlanar, "gravity", "friction = 0.3\ngravity",
     "2:12: friction: got 0.3, allowed: a table"},
    {"InertiaIsOtherText", kSpatial, "inertia = [1, 1, 1]", "inertia = \"solid\"",
     "23:11: body 'block' inertia: got 'solid'"},
    {"UniformOffCentre", kSpatial, "inertia = [1, 1, 1]\nposition = [5, 0, 1]\nshape = { type = \"box\",",
     "inertia = \"uniform\"\nposition = [5, 0, 1]\nshape = { type = \"cone\", radius = 1, height = 1 "
     "}\n[[body]]\nname = \"b\"\nmass = 1.0\ninertia = [1, 1, 1]\nposition = [9, 0, 1]\nshape = { type = "
     "\"box\",",
     "23:11: body 'block' inertia: got 'uniform', of a solid with its centre of mass at [0, 0, 0.25], "
     "allowed: a centre of mass at the body's origin, as with center = [0, 0, -0.25] in the shape"},
    {"UniformHalfSpace", kSpatial, "inertia = [0.4, 0.4, 0.4]\n",
     "inertia = \"uniform\"\nshape = { type = \"half_space\", normal = [0, 0, 1], offset = 0 "
     "}\n[[body]]\nname = \"b\"\nmass = 1\ninertia = [1, 1, 1]\n",
     "11:11: body 'ball' inertia: got 'uniform', allowed: numbers [kg m^2] ("},
    {"MassOfAUniform", kSpatial, "mass = 1.0\ninertia = [0.4, 0.4, 0.4]", "mass = -1\ninertia = \"uniform\"",
     "10:8: body 'ball' mass: got -1"},
    {"OneOfThemIsText", kSpatial, "position = [0, 0, 1]", "position = [0, \"0\", 1]",
     "12:16: body 'ball' position[1]: got '0', allowed: a number"},
    // Of another length.
    {"GravityOfPlane", kSpatial, "[0, 0, -9.81]", "[0, -9.81]",
     "2:11: gravity: got 2 numbers, allowed: 3 numbers"},
    {"GravityOfSpace", kPlanar, "[0, -9.81]", "[0, 0, -9.81]",
     "2:11: gravity: got 3 numbers, allowed: 2 numbers"},
    {"PositionEmpty", kSpatial, "position = [0, 0, 1]", "position = []",
     "12:12: body 'ball' position: got 0 numbers"},
    {"InertiaOf4", kSpatial, "[0.4, 0.4, 0.4]", "[0.4, 0.4, 0.4, 0]",
     "11:11: body 'ball' inertia: got 4 numbers, allowed: 3 principal moments or the 6 elements"},
    {"InertiaOfSpace", kPlanar, "inertia = 0.5", "inertia = [1, 1, 1]",
     "6:11: body 'disc' inertia: got a list of 3, allowed: a number"},
    {"Quaternion3", kSpatial, "[1, 0, 0, 0]", "[1, 0, 0]",
     "13:15: body 'ball' orientation: got 3 numbers, allowed: 4 numbers"},
    {"QuaternionInPlane", kPlanar, "position = [0, 1]", "orientation = [1, 0, 0, 0]",
     "7:15: body 'disc' orientation: got a list of 4, allowed: a number"},
    {"SpinOfSpace", kPlanar, "angular_velocity = 3", "angular_velocity = [0, 0, 3]",
     "8:20: body 'disc' angular_velocity: got a list of 3"},
    {"SemiAxes2", kSpatial, "semi_axes = [1, 1, 1]", "semi_axes = [1, 1]",
     "15:43: body 'ball' shape.semi_axes: got 2 numbers"},
    {"PairOf3", kSpatial, "[\"ball\", \"ground\"]", "[\"ball\", \"ground\", \"block\"]",
     "27:10: pair 1 bodies: got 3 entries"},
    // Not finite.
    {"MassNan", kSpatial, "mass = 1.0", "mass = nan",
     "10:8: body 'ball' mass: got nan, allowed: a finite number"},
    {"PositionInf", kSpatial, "position = [0, 0, 1]", "position = [0, -inf, 1]",
     "12:16: body 'ball' position[1]: got -inf"},
    {"VelocityNan", kSpatial, "velocity = [0, 0, 0]", "velocity = [0, 0, nan]",
     "14:19: body 'ball' velocity[2]: got nan"},
    {"GravityNan", kSpatial, "[0, 0, -9.81]", "[0, 0, nan]", "2:18: gravity[2]: got nan"},
    {"RadiusInf", kPlanar, "radius = 1", "radius = inf", "9:35: body 'disc' shape.radius: got inf"},
    {"MuNan", kSpatial, "mu = 0.2", "mu = nan", "4:6: friction.mu: got nan"},
    // Out of range.
    {"Dimension4", kSpatial, "dimension = 3", "dimension = 4", "1:13: dimension: got 4, allowed: 2 or 3"},
    {"DimensionTooLarge", kSpatial, "dimension = 3", "dimension = 4294967299",
     "1:13: dimension: got 4294967299"},
    {"MassNegative", kSpatial, "mass = 1.0", "mass = -1.5",
     "10:8: body 'ball' mass: got -1.5, allowed: a finite number > 0 [kg]"},
    {"MassZero", kSpatial, "mass = 1.0", "mass = 0", "10:8: body 'ball' mass: got 0"},
    {"InertiaNegative", kPlanar, "inertia = 0.5", "inertia = -0.5", "6:11: body 'disc' inertia: got -0.5"},
    {"InertiaTriangle", kSpatial, "[0.4, 0.4, 0.4]", "[0.4, 0.4, 0.9]",
     "11:11: body 'ball' inertia (largest principal moment): got 0.9, allowed: at most the sum of the other "
     "two, 0.8"},
    {"InertiaOf6Triangle", kSpatial, "[0.4, 0.4, 0.4]", "[0.4, 0.4, 0.4, 0.3, 0, 0]",
     "11:11: body 'ball' inertia (largest principal moment)"},
    {"InertiaIndefinite", kSpatial, "[0.4, 0.4, 0.4]", "[0.4, 0.4, -0.4]",
     "11:11: body 'ball' inertia (least principal moment): got -0.4"},
    {"SemiAxisNegative", kSpatial, "semi_axes = [1, 1, 1]", "semi_axes = [1, 1, -1]",
     "15:50: body 'ball' shape.semi_axes[2]: got -1"},
    {"RadiusZero", kPlanar, "radius = 1", "radius = 0", "9:35: body 'disc' shape.radius: got 0"},
    {"ExponentBelow2", kSpatial, "\"ellipsoid\", semi_axes",
     "\"superellipsoid\", exponents = [2, 1.5, 2], semi_axes",
     "15:52: body 'ball' shape.exponents[1]: got 1.5"},
    {"TwoEdges", kPlanar, "\"disc\", radius = 1", "\"regular_polygon\", edges = 2, circumradius = 1",
     "9:45: body 'disc' shape.edges: got 2"},
    {"MuNegative", kSpatial, "mu = 0.2", "mu = -0.2",
     "4:6: friction.mu: got -0.2, allowed: a finite number >= 0"},
    {"SemiAxisOfFriction", kSpatial, "e_t = 1.0", "e_t = 0", "5:7: friction.e_t: got 0"},
    {"Restitution", kSpatial, "restitution = 0.0", "restitution = 1.1",
     "6:15: friction.restitution: got 1.1, allowed: a number from 0 to 1"},
    {"TangentZero", kSpatial, "tangent = [1, 0, 0]", "tangent = [0, 0, 0]",
     "7:11: friction.tangent: got zero"},
    {"MuOfAPairNegative", kSpatial, "mu = 0.3", "mu = -0.3", "28:6: pair 1.mu: got -0.3"},
    // No unit vectors.
    {"Normal", kSpatial, "normal = [0, 0, 1]", "normal = [0, 3, 4]",
     "19:41: body 'ground' shape.normal: got [0, 3, 4] of length 5, allowed: length 1 within 1e-9, as of [0, "
     "0.6, 0.8]"},
    {"NormalZero", kSpatial, "normal = [0, 0, 1]", "normal = [0, 0, 0]",
     "19:41: body 'ground' shape.normal: got [0, 0, 0] of length 0"},
    {"NormalRounded", kSpatial, "normal = [0, 0, 1]", "normal = [0.7071, 0, 0.7071]",
     "19:41: body 'ground' shape.normal: got [0.7071, 0, 0.7071] of length 0.9999"},
    {"Quaternion", kSpatial, "[1, 0, 0, 0]", "[1, 0, 0, 1]",
     "13:15: body 'ball' orientation: got [1, 0, 0, 1] of length 1.414"},
    {"QuaternionZero", kSpatial, "[1, 0, 0, 0]", "[0, 0, 0, 0]",
     "13:15: body 'ball' orientation: got [0, 0, 0, 0] of length 0"},
    {"Axis", kSpatial, "axis = [0, 1, 0]", "axis = [0, 1, 1]",
     "33:8: joint 1 axis: got [0, 1, 1] of length 1.414"},
    // Keys that nobody knows.
    {"UnknownAtTop", kSpatial, "gravity", "gravty = 1\ngravity",
     "2:1: gravty: got an unknown key (did you mean 'gravity'?), allowed: body, dimension, friction, "
     "gravity, joint, pair"},
    {"UnknownInBody", kSpatial, "mass = 1.0", "mas = 1.0",
     "10:1: body 1 mas: got an unknown key (did you mean 'mass'?)"},
    {"UnknownInShape", kSpatial, "semi_axes", "semiaxes",
     "15:31: body 'ball' shape.semiaxes: got an unknown key (did you mean 'semi_axes'?), allowed: center, "
     "rotation, semi_axes, type"},
    {"KeyOfAnotherShape", kPlanar, "radius = 1", "radius = 1, half_height = 1",
     "9:38: body 'disc' shape.half_height: got an unknown key, allowed"},
    {"UnknownInFriction", kSpatial, "e_t", "e_x", "5:1: friction.e_x: got an unknown key"},
    {"UnknownInPair", kSpatial, "mu = 0.3", "nu = 0.3",
     "28:1: pair 1 nu: got an unknown key (did you mean 'mu'?)"},
    {"UnknownInJoint", kSpatial, "anchor", "anker",
     "32:1: joint 1 anker: got an unknown key (did you mean 'anchor'?)"},
    // Names that nobody has, and names that two have.
    {"UnknownShape", kSpatial, "\"ellipsoid\"", "\"elipsoid\"",
     "15:18: body 'ball' shape.type: got 'elipsoid' (did you mean 'ellipsoid'?), allowed: box, capsule"},
    {"ShapeOfThePlane", kSpatial, "\"ellipsoid\"", "\"regular_polygon\"",
     "15:18: body 'ball' shape.type: got 'regular_polygon'"},
    {"ShapeOfSpace", kPlanar, "\"disc\", radius", "\"capsule\", radius",
     "9:18: body 'disc' shape.type: got 'capsule'"},
    {"UnknownBodyInPair", kSpatial, "\"ball\", \"ground\"", "\"ball\", \"grund\"",
     "27:19: pair 1 bodies[1]: got 'grund' (did you mean 'ground'?), allowed: ball, ground, block"},
    {"UnknownBodyInJoint", kSpatial, "\"ball\", \"block\"", "\"bell\", \"block\"",
     "31:11: joint 1 bodies[0]: got 'bell' (did you mean 'ball'?)"},
    {"UnknownJoint", kSpatial, "\"hinge\"", "\"screw\"",
     "30:8: joint 1 type: got 'screw', allowed: ball, fixed, hinge, slider"},
    {"NameTwice", kSpatial, "\"block\"", "\"ball\"",
     "21:8: body 3 name: got 'ball' twice, allowed: a different name for each body"},
    {"BodyWithItself", kSpatial, "\"ball\", \"ground\"", "\"ball\", \"ball\"",
     "27:19: pair 1 bodies[1]: got one body twice"},
    {"PairTwice", kSpatial, "", "[[pair]]\nbodies = [\"ground\", \"ball\"]\n",
     "34:1: pair 2: got two bodies that an earlier pair has too"},
    {"PairOfFixed", kSpatial, "name = \"ball\"", "name = \"ball\"\nfixed = true",
     "28:10: pair 1 bodies: got two fixed bodies"},
    {"AxisOfABall", kSpatial, "\"hinge\"", "\"ball\"",
     "33:8: joint 1 axis: got a value, allowed: none, because this joint has no axis"},
    {"AxisOfAPlanarHinge", kPlanar, "\"slider\"", "\"hinge\"", "18:8: joint 1 axis: got a value"},
    // Shapes without an inside.
    {"NoParts", kSpatial, "\"ellipsoid\", semi_axes = [1, 1, 1]", "\"intersection\", parts = []",
     "15:42: body 'ball' shape.parts: got none"},
    {"PartsApart", kSpatial, "\"ellipsoid\", semi_axes = [1, 1, 1]",
     "\"intersection\", parts = [{ type = \"sphere\", radius = 1 }, { type = \"sphere\", radius = 1, center "
     "= [3, 0, 0] }]",
     "15:9: body 'ball' shape: got parts whose common depth is -"},
    {"PartsThatOnlyTouch", kPlanar, "\"disc\", radius = 1",
     "\"intersection\", parts = [{ type = \"disc\", radius = 1 }, { type = \"half_space\", normal = [0, 1], "
     "offset = -1 }]",
     "9:9: body 'disc' shape: got parts whose common depth is "},
    {"PartOfAPart", kSpatial, "\"ellipsoid\", semi_axes = [1, 1, 1]",
     "\"intersection\", parts = [{ type = \"sphere\", radius = 1 },\n { type = \"sphere\", radius = -1 }]",
     "16:30: body 'ball' shape.parts[1].radius: got -1"},
    {"PlanesThatDoNotClose", kPlanar, "\"disc\", radius = 1",
     "\"polytope\", planes = [{ normal = [1, 0], offset = 1 }, { normal = [-1, 0], offset = 1 }, { normal = "
     "[0, 1], offset = 1 }]",
     "9:39: body 'disc' shape.planes: got an "},
    {"PlaneWithNoUnitNormal", kPlanar, "\"disc\", radius = 1",
     "\"polytope\", planes = [{ normal = [2, 0], offset = 1 }]",
     "9:51: body 'disc' shape.planes[0].normal: got [2, 0] of length 2"},
    {"FlatPolytope", kPlanar, "\"disc\", radius = 1", "\"polytope\", vertices = [[0, 0], [1, 1], [2, 2]]",
     "9:41: body 'disc' shape.vertices: got a flat set of points"},
    {"TwoVertices", kPlanar, "\"disc\", radius = 1", "\"polytope\", vertices = [[0, 0], [1, 1]]",
     "9:41: body 'disc' shape.vertices: got 2"},
    {"NeitherPlanesNorVertices", kPlanar, "\"disc\", radius = 1", "\"polytope\"",
     "9:9: body 'disc' shape: got neither planes nor vertices"},
    {"PlanesAndVertices", kPlanar, "\"disc\", radius = 1", "\"polytope\", planes = [], vertices = []",
     "9:9: body 'disc' shape: got both planes and vertices"},
    // Where they start.
    {"Overlap", kSpatial, "position = [0, 0, 1]", "position = [0, 0, 0.75]",
     "12:12: body 'ball' position: got an overlap of 0.25 m with 'ground', allowed: at most 1e-09 m at the "
     "start"},
    {"OverlapOfTwoThatMove", kSpatial, "",
     "[[body]]\nname = \"late\"\nmass = 1\ninertia = [1, 1, 1]\nposition = [1.5, 0, 1]\nshape = { type = "
     "\"sphere\", radius = 1 }\n",
     "38:12: body 'late' position: got an overlap of 0.5 m with 'ball'"},
    {"FixedThatMoves", kSpatial, "fixed = true", "fixed = true\nvelocity = [1, 0, 0]",
     "19:12: body 'ground' velocity: got a value on a fixed body"},
    {"FixedThatTurns", kSpatial, "fixed = true", "fixed = true\nangular_velocity = [1, 0, 0]",
     "19:20: body 'ground' angular_velocity: got a value on a fixed body"},
    {"FixedThatIsPushed", kSpatial, "fixed = true", "fixed = true\nforce = [1, 0, 0]",
     "19:9: body 'ground' force: got a value on a fixed body"},
};

INSTANTIATE_TEST_SUITE_P(SceneFile, Malformed, testing::ValuesIn(kFaults),
                         [](const auto& fault) { return std::string(fault.param.name); });

}  // namespace
}  // namespace touchstone::scene_file
