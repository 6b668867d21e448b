#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "models/solve.h"

namespace continuum {
namespace {

using testing::HasSubstr;

SolveRequest Segment() {
  SolveRequest request;
  request.robot = CONTINUUM_SOURCE "/models/tdcr/tdcr.yaml";
  request.input = request.out = "-";
  return request;
}

TEST(SolveStream, AnswersEveryRowUnderOneHeader) {
  std::istringstream in("case,T1,T2,T3,fx,fy,fz\na,1,0,0,0,0,0\n\nb,2,0,0,0,0,0\n");
  std::ostringstream out;
  EXPECT_EQ(SolveStream(Segment(), in, out), 0);
  std::istringstream lines(out.str());
  std::string header, a, b, more;
  std::getline(lines, header);
  std::getline(lines, a);
  std::getline(lines, b);
  EXPECT_EQ(header.rfind("case,status", 0), 0u);
  EXPECT_EQ(a.rfind("a,ok", 0), 0u);
  EXPECT_EQ(b.rfind("b,ok", 0), 0u);
  EXPECT_FALSE(std::getline(lines, more));
}

TEST(SolveStream, NamesTheRowThatIsWrongAndOptionsThatNeedAll) {
  std::istringstream in("case,T1,T2,T3,fx,fy,fz\na,1,0,0,0,0,0\nb,-2,0,0,0,0,0\n");
  std::ostringstream out;
  try {
    SolveStream(Segment(), in, out);
    ADD_FAILURE() << "no error";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("row 2"));
  }
  EXPECT_THAT(out.str(), HasSubstr("\na,ok"));
  SolveRequest request = Segment();
  request.sweep = 3;
  EXPECT_THROW(SolveStream(request, in, out), Error);
  std::istringstream empty("");
  EXPECT_THROW(SolveStream(Segment(), empty, out), Error);
}

}  // namespace
}  // namespace continuum
