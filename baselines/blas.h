#pragma once

namespace touchstone {

/// Makes OpenBLAS, which Siconos and Simbody call, round alike whatever the processor: its kernels are those
/// for AVX2 and FMA (OpenBLAS's type Haswell) also where it would choose others, whatever OPENBLAS_CORETYPE
/// says, and it runs on one thread, which at the sizes of a contact problem is the fastest, too. Otherwise a
/// Newton method that is lost, or that circles among degenerate pairs, takes another number of iterations on
/// each kind of processor, and solves in one place what it does not in another.
///
/// Nothing happens on a processor without AVX2 and FMA, where glibc's functions round otherwise as well, nor
/// if another BLAS is loaded, or an OpenBLAS made for one processor only. To be called before anybody in the
/// process is within OpenBLAS; calls after the first do nothing.
void use_same_blas_everywhere();

}  // namespace touchstone
