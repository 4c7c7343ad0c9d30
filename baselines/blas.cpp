#include "baselines/blas.h"

#include <dlfcn.h>

#include <cstdlib>
#include <mutex>

namespace touchstone {

namespace {

/// A function of OpenBLAS, or null: it is found by name, so that nothing here is linked to it.
template <typename Function>
Function* openblas(const char* name) {
  // POSIX makes the conversion of what dlsym() gives to a function's address a valid one.
  return reinterpret_cast<Function*>(::dlsym(RTLD_DEFAULT, name));
}

bool has_avx2_and_fma() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
#else
  return false;
#endif
}

/// The library reads its environment when it is loaded, which was before main(). Its own end and beginning,
/// between which it chooses kernels, make it read again.
void choose_kernels() {
  auto* const end = openblas<void()>("gotoblas_dynamic_quit");
  auto* const begin = openblas<void()>("gotoblas_dynamic_init");
  if (end == nullptr || begin == nullptr || !has_avx2_and_fma()) return;
  ::setenv("OPENBLAS_CORETYPE", "Haswell", 1);
  end();
  begin();
}

}  // namespace

void use_same_blas_everywhere() {
  static std::once_flag once;
  std::call_once(once, [] {
    choose_kernels();
    if (auto* const set_threads = openblas<void(int)>("openblas_set_num_threads")) set_threads(1);
  });
}

}  // namespace touchstone
