#pragma once

#include <string>
#include <vector>

namespace continuum {

/// Takes what MuJoCo and its plugins warn of on this thread while it lives.
class EngineWarnings {
 public:
  EngineWarnings();
  ~EngineWarnings();
  EngineWarnings(const EngineWarnings&) = delete;

  /// In the order in which they came.
  const std::vector<std::string>& texts() const { return texts_; }
  /// As mju_user_warning: what nobody takes is dropped.
  static void Take(const char* text);

 private:
  std::vector<std::string> texts_;
  EngineWarnings* outer_;
};

}  // namespace continuum
