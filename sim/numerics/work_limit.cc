#include "sim/numerics/work_limit.h"

namespace continuum::numerics {
namespace {

thread_local WorkLimit* innermost = nullptr;

}  // namespace

std::string GaveUp::Sentence() const {
  return "given up after " + std::to_string(systems) + " linear systems" +
         (where.empty() ? "" : ", " + where);
}

WorkLimit::WorkLimit(long most) : most_(most), outer_(innermost) { innermost = this; }

WorkLimit::~WorkLimit() { innermost = outer_; }

void WorkLimit::Spend(long systems) {
  const WorkLimit* full = nullptr;
  for (WorkLimit* limit = innermost; limit != nullptr; limit = limit->outer_) {
    limit->spent_ += systems;
    if (limit->exceeded()) full = limit;
  }
  if (full != nullptr) throw GaveUp{full->spent_};
}

}  // namespace continuum::numerics
