#include "sim/model/engine_warnings.h"

namespace continuum {
namespace {

thread_local EngineWarnings* taker = nullptr;

}  // namespace

EngineWarnings::EngineWarnings() : outer_(taker) { taker = this; }

EngineWarnings::~EngineWarnings() { taker = outer_; }

void EngineWarnings::Take(const char* text) {
  if (taker) taker->texts_.emplace_back(text);
}

}  // namespace continuum
