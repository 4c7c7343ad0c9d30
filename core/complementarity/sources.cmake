target_sources(touchstone_core PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/basis_core.cpp
  ${CMAKE_CURRENT_LIST_DIR}/column_cache.cpp
  ${CMAKE_CURRENT_LIST_DIR}/complementary_basis.cpp
  ${CMAKE_CURRENT_LIST_DIR}/dense_lu.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fischer_burmeister.cpp
  ${CMAKE_CURRENT_LIST_DIR}/linear_path.cpp
  ${CMAKE_CURRENT_LIST_DIR}/merit_search.cpp
  ${CMAKE_CURRENT_LIST_DIR}/path_newton.cpp
  ${CMAKE_CURRENT_LIST_DIR}/ratio_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/report.cpp
  ${CMAKE_CURRENT_LIST_DIR}/require.cpp
  ${CMAKE_CURRENT_LIST_DIR}/residual.cpp
  ${CMAKE_CURRENT_LIST_DIR}/semismooth_newton.cpp
  ${CMAKE_CURRENT_LIST_DIR}/solver_chain.cpp
)
