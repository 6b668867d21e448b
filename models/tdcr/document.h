#pragma once

#include "models/statics/yaml_document.h"
#include "models/tdcr/measured.h"

namespace continuum::tdcr {

using statics::List;
using statics::Number;
using statics::SetParameter;
using statics::WriteDocument;

/// {mean, std, min, max}
YAML::Node Document(const Spread& spread);
/// {train: {..}, test: {..}}, each only if it has cases.
YAML::Node Document(const TipErrors& errors);

}  // namespace continuum::tdcr
