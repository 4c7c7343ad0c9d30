# The independent checker: a library of its own, so that what it links says what it shares.
add_library(touchstone_certificate STATIC
  certificate/certificate.cpp
  certificate/contact_conditions.cpp
  certificate/separation.cpp
)
target_link_libraries(touchstone_certificate PUBLIC touchstone_core)
