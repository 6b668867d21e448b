#pragma once

#include <string>
#include <vector>

#include "sim/page/plot_spec.h"

namespace continuum::page {

/// HTML of a table. Throws Error (kInput) with its caption for sizes that do not fit together.
std::string TableHtml(const std::vector<std::string>& header,
                      const std::vector<std::vector<std::string>>& rows,
                      const TableOptions& options);

}  // namespace continuum::page
