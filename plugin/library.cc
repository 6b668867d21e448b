#include <exception>

#include "engine.h"

namespace continuum {
namespace {

mjPLUGIN_LIB_INIT(continuum) {
  try {
    RegisterEffects();
  } catch (const std::exception& e) {
    mju_warning("%s: no effect is registered", e.what());
  }
}

}  // namespace
}  // namespace continuum
