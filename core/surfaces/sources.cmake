target_sources(touchstone_core PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/active_set.cpp
  ${CMAKE_CURRENT_LIST_DIR}/cone.cpp
  ${CMAKE_CURRENT_LIST_DIR}/deepest_point.cpp
  ${CMAKE_CURRENT_LIST_DIR}/farthest_point.cpp
  ${CMAKE_CURRENT_LIST_DIR}/intersection.cpp
  ${CMAKE_CURRENT_LIST_DIR}/make_surface.cpp
  ${CMAKE_CURRENT_LIST_DIR}/normal_combination.cpp
  ${CMAKE_CURRENT_LIST_DIR}/radial_moments.cpp
  ${CMAKE_CURRENT_LIST_DIR}/superellipsoid.cpp
)
