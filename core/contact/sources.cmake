target_sources(touchstone_core PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/closest_multipliers.cpp
  ${CMAKE_CURRENT_LIST_DIR}/closest_newton.cpp
  ${CMAKE_CURRENT_LIST_DIR}/closest_points.cpp
  ${CMAKE_CURRENT_LIST_DIR}/expanding_polytope.cpp
  ${CMAKE_CURRENT_LIST_DIR}/gjk.cpp
  ${CMAKE_CURRENT_LIST_DIR}/patch_middle.cpp
  ${CMAKE_CURRENT_LIST_DIR}/side.cpp
)
