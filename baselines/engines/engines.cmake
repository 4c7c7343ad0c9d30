# The engines: one .cpp each, added if its library is there. Box2D, Bullet and ODE are required; the others are found
# if installed and wanted. An engine's absence is told at configuration and leaves its methods out of the table.
option(TOUCHSTONE_OPTIONAL_ENGINES "Look for MuJoCo, Chipmunk, DART, Siconos and Simbody" ON)
set(TOUCHSTONE_EXTRA_ENGINES "" CACHE STRING "Files NAME.cpp of engines outside baselines/engines that need no library")
set(engines_dir ${CMAKE_CURRENT_LIST_DIR})
find_package(PkgConfig REQUIRED)

target_sources(touchstone_baselines PRIVATE
  ${engines_dir}/engine_method.cpp
  ${engines_dir}/engines.cpp
  ${engines_dir}/extruded.cpp
  ${engines_dir}/laws.cpp
  ${engines_dir}/loaded_library.cpp
  ${engines_dir}/principal_axes.cpp
  ${engines_dir}/read_back.cpp
  ${engines_dir}/shapes.cpp
  ${engines_dir}/silence.cpp
)

# touchstone_engine(<name> <source> <target>...): the adapter, which defines Rows <name>_rows(), and its libraries.
function(touchstone_engine name source)
  cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${engines_dir})
  target_sources(touchstone_baselines PRIVATE ${source})
  target_link_libraries(touchstone_baselines PRIVATE ${ARGN} ${CMAKE_DL_LIBS})
  set_property(TARGET touchstone_baselines APPEND PROPERTY TOUCHSTONE_ENGINES ${name})
  message(STATUS "Engine ${name}: yes")
endfunction()

# The list that engines.cpp includes, written when all engines are known.
set(listed "$<TARGET_PROPERTY:touchstone_baselines,TOUCHSTONE_ENGINES>")
file(GENERATE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/engines/engines.inc
  CONTENT "TOUCHSTONE_ENGINE($<JOIN:${listed},)\nTOUCHSTONE_ENGINE(>)\n")
set_property(SOURCE ${engines_dir}/engines.cpp TARGET_DIRECTORY touchstone_baselines
  PROPERTY INCLUDE_DIRECTORIES ${CMAKE_CURRENT_BINARY_DIR}/engines)

# find_engine_package(<package> <argument>...): find_package, quietly. What a search that failed leaves in the cache is
# removed, or parts that were missing would stay so after they are installed. A macro, for find_package sets variables.
macro(find_engine_package package)
  get_cmake_property(known_before CACHE_VARIABLES)
  find_package(${package} ${ARGN} QUIET)
  if(NOT ${package}_FOUND)
    get_cmake_property(known_after CACHE_VARIABLES)
    set(of_package ${known_after})
    list(FILTER of_package INCLUDE REGEX "^${package}_")
    list(REMOVE_ITEM known_after ${known_before})
    foreach(variable IN LISTS known_after of_package)
      unset(${variable} CACHE)
    endforeach()
  endif()
endmacro()

find_package(box2d CONFIG REQUIRED)
touchstone_engine(box2d box2d.cpp box2d::box2d)

# Bullet in double precision in the library, and in single precision in a module: the two builds have the same symbol
# names with other layouts, so the module is loaded into a linker namespace of its own (bullet_float.cpp). There it has
# a C library of its own too, which no sanitizer knows: it is not instrumented, and has its own copy of what it needs.
pkg_check_modules(TOUCHSTONE_BULLET REQUIRED IMPORTED_TARGET bullet-float64)
pkg_check_modules(TOUCHSTONE_BULLET_FLOAT REQUIRED IMPORTED_TARGET bullet)
touchstone_engine(bullet bullet.cpp PkgConfig::TOUCHSTONE_BULLET)
target_sources(touchstone_baselines PRIVATE
  ${engines_dir}/bullet_float.cpp
  ${engines_dir}/bullet_world.cpp
)
add_library(touchstone_bullet_float MODULE
  ${engines_dir}/bullet_float_module.cpp
  ${engines_dir}/bullet_world.cpp
  ${engines_dir}/loaded_library.cpp
  ${engines_dir}/principal_axes.cpp
  ${engines_dir}/read_back.cpp
  ${engines_dir}/shapes.cpp
  ${PROJECT_SOURCE_DIR}/core/model/polytope.cpp
  ${PROJECT_SOURCE_DIR}/core/model/pose.cpp
  ${PROJECT_SOURCE_DIR}/core/model/scene.cpp
  ${PROJECT_SOURCE_DIR}/core/model/shape.cpp
)
set_target_properties(touchstone_bullet_float PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden)
target_include_directories(touchstone_bullet_float PRIVATE ${PROJECT_SOURCE_DIR})
target_link_libraries(touchstone_bullet_float PRIVATE
  touchstone_plain_flags Eigen3::Eigen fmt::fmt PkgConfig::TOUCHSTONE_BULLET_FLOAT)
target_link_options(touchstone_bullet_float PRIVATE LINKER:-z,defs)
add_dependencies(touchstone_baselines touchstone_bullet_float)
file(RELATIVE_PATH module_in_build ${PROJECT_BINARY_DIR} ${CMAKE_CURRENT_BINARY_DIR})
set_source_files_properties(${engines_dir}/bullet_float.cpp TARGET_DIRECTORY touchstone_baselines
  PROPERTIES COMPILE_DEFINITIONS
  "TOUCHSTONE_BULLET_FLOAT_MODULE=\"$<TARGET_FILE:touchstone_bullet_float>\";TOUCHSTONE_BULLET_FLOAT_IN_BUILD=\"${module_in_build}/$<TARGET_FILE_NAME:touchstone_bullet_float>\"")

pkg_check_modules(TOUCHSTONE_ODE REQUIRED IMPORTED_TARGET ode)
touchstone_engine(ode ode.cpp PkgConfig::TOUCHSTONE_ODE)

foreach(source IN LISTS TOUCHSTONE_EXTRA_ENGINES)
  cmake_path(GET source STEM name)
  touchstone_engine(${name} ${source})
endforeach()

if(NOT TOUCHSTONE_OPTIONAL_ENGINES)
  message(STATUS "Engines mujoco, chipmunk, dart, siconos, simbody: not wanted")
  return()
endif()

find_engine_package(mujoco CONFIG)
if(mujoco_FOUND)
  # Debian's file names an include folder that is not there; the headers are in the compiler's own.
  set_target_properties(mujoco::mujoco PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "")
  touchstone_engine(mujoco mujoco.cpp mujoco::mujoco)
  target_sources(touchstone_baselines PRIVATE ${engines_dir}/mujoco_model.cpp)
else()
  message(STATUS "Engine mujoco: not installed")
endif()

find_path(CHIPMUNK_INCLUDE_DIR chipmunk/chipmunk.h)
find_library(CHIPMUNK_LIBRARY chipmunk)
if(CHIPMUNK_INCLUDE_DIR AND CHIPMUNK_LIBRARY)
  add_library(chipmunk UNKNOWN IMPORTED)
  set_target_properties(chipmunk PROPERTIES IMPORTED_LOCATION ${CHIPMUNK_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${CHIPMUNK_INCLUDE_DIR})
  touchstone_engine(chipmunk chipmunk.cpp chipmunk)
else()
  message(STATUS "Engine chipmunk: not installed")
endif()

# DART's file wants its parts' development packages too; without one of them it counts as not installed.
find_engine_package(DART 6 CONFIG COMPONENTS collision-ode)
if(DART_FOUND AND TARGET dart AND TARGET dart-collision-ode)
  touchstone_engine(dart dart.cpp dart dart-collision-ode)
  target_sources(touchstone_baselines PRIVATE ${engines_dir}/dart_materials.cpp)
else()
  message(STATUS "Engine dart: not installed")
endif()

# Siconos's own file sets the C++ standard of its includer and wants the whole package, so it is not used.
find_path(SICONOS_INCLUDE_DIR siconos/numerics/FrictionContactProblem.h)
find_path(SUITESPARSE_INCLUDE_DIR cs.h PATH_SUFFIXES suitesparse)
find_library(SICONOS_NUMERICS_LIBRARY siconos_numerics)
if(SICONOS_INCLUDE_DIR AND SICONOS_NUMERICS_LIBRARY AND SUITESPARSE_INCLUDE_DIR)
  add_library(siconos_numerics UNKNOWN IMPORTED)
  set_target_properties(siconos_numerics PROPERTIES IMPORTED_LOCATION ${SICONOS_NUMERICS_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES
    "${SICONOS_INCLUDE_DIR}/siconos;${SICONOS_INCLUDE_DIR}/siconos/numerics;${SUITESPARSE_INCLUDE_DIR}")
  touchstone_engine(siconos siconos.cpp siconos_numerics)
  # The library has no function that tells its version; the folder of its CMake files does.
  file(GLOB siconos_cmake ${SICONOS_INCLUDE_DIR}/../lib/cmake/siconos-*)
  string(REGEX REPLACE ".*/siconos-" "" siconos_version "${siconos_cmake}")
  set_source_files_properties(${engines_dir}/siconos.cpp TARGET_DIRECTORY touchstone_baselines
    PROPERTIES COMPILE_DEFINITIONS TOUCHSTONE_SICONOS_VERSION="${siconos_version}")
  target_sources(touchstone_baselines PRIVATE ${engines_dir}/simple_contacts.cpp)
else()
  message(STATUS "Engine siconos: not installed")
endif()

find_engine_package(Simbody CONFIG)
if(Simbody_FOUND AND TARGET SimTKsimbody)
  # Its headers do not compile as C++20 (operator== of its index types), so the part that includes them is C++17.
  add_library(touchstone_simbody OBJECT ${engines_dir}/simbody_world.cpp)
  set_target_properties(touchstone_simbody PROPERTIES CXX_STANDARD 17)
  target_link_libraries(touchstone_simbody PRIVATE touchstone_core SimTKsimbody)
  touchstone_engine(simbody simbody.cpp SimTKsimbody)
  target_sources(touchstone_baselines PRIVATE $<TARGET_OBJECTS:touchstone_simbody>)
else()
  message(STATUS "Engine simbody: not installed")
endif()
