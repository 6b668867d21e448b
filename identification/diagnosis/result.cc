#include "identification/diagnosis/result.h"

#include "sim/io/interrupt.h"

namespace continuum {

void DiagnosisOptions::Say(const std::string& text) const {
  StopIfRequested();
  if (progress) progress(text);
}

}  // namespace continuum
