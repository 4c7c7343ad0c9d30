#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/stepper/layout.h"

namespace touchstone {

/// Splits the moving bodies of a step into islands: parts between which no contact and no joint acts, since
/// fixed bodies pass nothing on. Each is a problem of its own.
///
/// Islands are in the order of their first bodies, and bodies, joints and contacts within one in the order in
/// which they were given.
class Islands {
 public:
  /// One island: numbers of bodies and joints as given, and of contacts.
  struct Island {
    std::span<const int> bodies;
    std::span<const int> joints;
    std::span<const std::size_t> contacts;
  };

  template <int Dim>
  explicit Islands(const Scene<Dim>& scene);

  /// Splits anew. Does not allocate once as many contacts were seen.
  template <int Dim>
  void split(const Scene<Dim>& scene, std::span<const ContactPair<Dim>> contacts);

  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] Island operator[](std::size_t i) const;

 private:
  [[nodiscard]] std::size_t root(int body);
  void join(int a, int b);
  template <typename Number, typename IslandOf>
  void sort(std::size_t count, const IslandOf& island_of, std::vector<std::size_t>& begin,
            std::vector<Number>& sorted);

  std::vector<bool> moves_;
  std::vector<std::size_t> parent_;
  std::vector<std::size_t> island_;  ///< of a body; kNone for a fixed one
  std::size_t count_ = 0;
  std::vector<std::size_t> body_begin_, joint_begin_, contact_begin_;
  std::vector<int> bodies_, joints_;
  std::vector<std::size_t> contacts_;
};

}  // namespace touchstone
