#include "app/rank_job.h"

#include <cstdio>
#include <string>

#include "app/console.h"
#include "sim/io/interrupt.h"
#include "sim/numerics/ranks.h"

namespace continuum {

bool GoOnAlone() {
  if (RankCount() == 1) return true;
  StopIfRequested();
  const std::string loads = RankLoads();
  LeaveRanks();
  if (ThisRank() > 0) return false;
  EndProgress();
  std::fprintf(stderr, "%s\n", loads.c_str());
  return true;
}

}  // namespace continuum
