#pragma once

#include <string>

#include "core/method.h"

namespace touchstone::engines {

/// What an engine has no counterpart for must not be dropped in silence.
/// @throws Unsupported naming the first quantity of a contact law, or joint, that `capabilities` does not
/// have
template <int Dim>
void refuse_unsupported(const std::string& method, const Scene<Dim>& scene, const Capabilities& capabilities);

}  // namespace touchstone::engines
