#pragma once

#include <string>
#include <string_view>

/// Which file a library was loaded from. For libraries that tell their version in no function: what headers
/// and CMake files say is of the day of the build, the file is what ran.
namespace touchstone::engines {

/// The name of the file that holds the code of `function`, links followed, without its folder:
/// "libdart.so.6.12.1".
/// @param function  address of a function of the library that is linked, not of an inline one
/// @throws std::runtime_error if no loaded file holds it
std::string loaded_file(const void* function);

/// What the numbers behind ".so." in a library's file name are.
enum class FileNumber {
  release,    ///< of the release, as in libdart.so.6.12.1; perhaps without the last ones
  interface,  ///< of its binary interface, which tells nothing of the release, as in libode.so.8.0.2
};

/// The version that the build saw and the file that ran, "6.12.1 (libdart.so.6.12.1)".
/// @throws IoError naming both if the file is that of another release
std::string version_and_file(std::string_view version, const std::string& file, FileNumber number);

}  // namespace touchstone::engines
