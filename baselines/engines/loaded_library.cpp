#include "baselines/engines/loaded_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "core/model/errors.h"

namespace touchstone::engines {

namespace {

Dl_info holder_of(const void* address) {
  Dl_info info{};
  if (dladdr(address, &info) == 0 || info.dli_fname == nullptr)
    throw std::runtime_error(fmt::format("no loaded file holds the address {}", address));
  return info;
}

/// Whether one of two dotted numbers begins the other: 6.12 and 6.12.1, but not 6.1 and 6.12.
bool agree(std::string_view a, std::string_view b) {
  if (a.size() > b.size()) std::swap(a, b);
  return b.starts_with(a) && (b.size() == a.size() || b[a.size()] == '.');
}

}  // namespace

std::string loaded_file(const void* function) {
  Dl_info info = holder_of(function);
  // In a program that is not position-independent the address is that of the program's own entry for it.
  if (info.dli_fbase == holder_of(reinterpret_cast<const void*>(&loaded_file)).dli_fbase &&
      info.dli_sname != nullptr) {
    if (const void* definition = dlsym(RTLD_NEXT, info.dli_sname)) info = holder_of(definition);
  }
  return std::filesystem::canonical(info.dli_fname).filename();
}

std::string version_and_file(std::string_view version, const std::string& file, FileNumber number) {
  constexpr std::string_view kMark = ".so.";
  const auto mark = file.find(kMark);
  if (number == FileNumber::release && mark != std::string::npos &&
      !agree(version, std::string_view(file).substr(mark + kMark.size()))) {
    throw IoError(
        fmt::format("built for version {} of a library, but {} was loaded: build again with the headers of "
                    "the library that is installed",
                    version, file));
  }
  return fmt::format("{} ({})", version, file);
}

}  // namespace touchstone::engines
