#pragma once

#include <toml++/toml.h>

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/errors.h"

/// The values of a scene file with their places in it, so that whatever is wrong with one can be told with
/// file, line, column, key, value and what is allowed.
namespace touchstone::scene_file {

using Keys = std::vector<std::string_view>;

/// Bad input of which the message already says where it stands.
class LocatedError final : public InputError {
 public:
  using InputError::InputError;
};

class Table;

/// One value of the file. It refers to the parsed document and to the file's name, which must outlive it.
/// Every reading function throws a LocatedError if the value is of another kind than the one asked for.
class Value {
 public:
  /// @param name  what messages call it: "body 'ball' mass"
  Value(const toml::node& node, std::string name, const std::string& file)
      : node_(&node), name_(std::move(name)), file_(&file) {}

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] bool is_text() const;
  [[nodiscard]] bool is_list() const;

  /// Finite; an integer will do.
  [[nodiscard]] double number() const;
  [[nodiscard]] int integer() const;
  [[nodiscard]] bool flag() const;
  /// Not empty.
  [[nodiscard]] std::string text() const;
  /// A text that is one of `allowed`; its index there.
  [[nodiscard]] std::size_t choice(std::span<const std::string_view> allowed) const;
  [[nodiscard]] std::vector<Value> list() const;
  /// A list of finite numbers, of any length.
  [[nodiscard]] std::vector<double> numbers() const;
  /// A list of N finite numbers.
  template <int N>
  [[nodiscard]] Eigen::Matrix<double, N, 1> vector() const {
    const std::vector<double> values = numbers();
    if (values.size() != N) fail_length(values.size(), std::to_string(N) + " numbers");
    return Eigen::Map<const Eigen::Matrix<double, N, 1>>(values.data());
  }
  /// N numbers of length 1 within 1e-9. What is not is told with the unit vector of its direction.
  template <int N>
  [[nodiscard]] Eigen::Matrix<double, N, 1> unit_vector() const {
    const Eigen::Matrix<double, N, 1> v = vector<N>();
    require_unit({v.data(), static_cast<std::size_t>(N)});
    return v;
  }
  /// What a table holds at `key`, for where that decides which other keys there are.
  /// @param what  it must be, for the message if it is missing
  [[nodiscard]] Value member(std::string_view key, std::string_view what) const;
  /// A table with no other keys than `keys`.
  /// @param separator  between the name of the table and that of a key, in messages
  [[nodiscard]] Table table(const Keys& keys, std::string_view separator = ".") const;

  /// The same value under another name.
  [[nodiscard]] Value named(std::string name) const { return {*node_, std::move(name), *file_}; }

  [[noreturn]] void fail(const std::string& got, const std::string& allowed) const;
  /// About what `path` leads to from here, or as far as the file has it: ".parts[1].radius".
  [[noreturn]] void fail_at(std::string_view path, const std::string& got, const std::string& allowed) const;
  [[noreturn]] void fail_length(std::size_t got, const std::string& allowed) const;

  /// The result of `check()`. An InputError of it about "<root><path>" becomes one about what `path` leads to
  /// from here, under this value's name in the place of `root`.
  template <typename Check>
  auto checked(std::string_view root, const Check& check) const {
    try {
      return check();
    } catch (const LocatedError&) {
      throw;
    } catch (const InputError& error) {
      fail_again(root, error.what());
    }
  }

 private:
  [[noreturn]] void fail_kind(const std::string& allowed) const;
  [[noreturn]] void fail_again(std::string_view root, std::string_view message) const;
  void require_unit(std::span<const double> v) const;

  const toml::node* node_;
  std::string name_;
  const std::string* file_;
};

/// A table of the file of which every key is known.
class Table {
 public:
  /// @throws LocatedError if a key is not one of `keys`, naming the nearest of them
  Table(const toml::table& table, std::string name, std::string_view separator, const std::string& file,
        const Keys& keys);

  /// @param key  one of `keys`
  [[nodiscard]] std::optional<Value> find(std::string_view key) const;
  /// @param what  the key must hold, for the message if it is missing: "a number > 0 [kg]"
  [[nodiscard]] Value require(std::string_view key, std::string_view what) const;
  /// The number at `key`, if there is one; otherwise `number` is left as it is.
  void read(std::string_view key, double& number) const;

  /// @throws LocatedError about the table as a whole
  [[noreturn]] void fail(const std::string& got, const std::string& allowed) const;

 private:
  const toml::table* table_;
  std::string name_;
  std::string prefix_;
  const std::string* file_;
  Keys keys_;
};

}  // namespace touchstone::scene_file
