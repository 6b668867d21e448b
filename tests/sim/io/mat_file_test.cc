#include "sim/io/mat_file.h"

#include <cstdint>
#include <cstring>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// Columns t (double) and q (single), a matrix x of 2 x 2, a text s.
class Mat : public ::testing::TestWithParam<const char*> {
 protected:
  static std::string Bytes(const std::string& name) {
    return testing::Scratch::Text(CONTINUUM_SOURCE "/tests/fuzz/seeds/mat/" + name);
  }
  Columns Read(const std::string& bytes, const std::string& variable = "") const {
    return ReadMat(scratch_.Write("log.mat", bytes), variable);
  }
  testing::Scratch scratch_;
};
INSTANTIATE_TEST_SUITE_P(Version5, Mat, ::testing::Values("plain.mat", "zipped.mat"),
                         [](const auto& info) { return std::string(info.param, 5); });

TEST_P(Mat, GivesVectorsByNameAndColumnsOfAMatrix) {
  const Columns x = Read(Bytes(GetParam()), "x");
  EXPECT_THAT(x.names, ElementsAre("1", "2"));
  EXPECT_THAT(x.values, ElementsAre(ElementsAre(0, 0.1), ElementsAre(0.2, 0.3)));
  const Columns all = Read(Bytes(GetParam()));
  EXPECT_THAT(all.names, ElementsAre("t", "q"));
  EXPECT_THAT(all.values, ElementsAre(ElementsAre(0, .1, .2, .3), ElementsAre(1, 2, 3, 4)));
}

TEST_F(Mat, OfVersion4IsRefused) {
  std::string bytes;
  for (const std::int32_t word : {0, 2, 1, 0, 2})
    bytes.append(reinterpret_cast<const char*>(&word), 4);
  bytes += std::string("t\0", 2) + std::string(16, '\0');
  EXPECT_THAT([&] { Read(bytes); },
              ThrowsMessage<Error>(HasSubstr("expected a MATLAB file of version 5 or 7.3")));
}

TEST_F(Mat, ThatPromisesMoreThanItHoldsIsRefused) {
  std::string bytes = Bytes("plain.mat");
  const std::int32_t rows = 2'000'000'000;
  std::memcpy(bytes.data() + 128 + 32, &rows, 4);  // of t: after its tag, its flags, a tag
  EXPECT_THAT([&] { Read(bytes); }, ThrowsMessage<Error>(AllOf(HasSubstr("log.mat: t: expected at "
                                                                         "most "))));
  EXPECT_THAT([&] { Read(bytes, "t"); }, ThrowsMessage<Error>(HasSubstr("log.mat: t: ")));
}

// It has two billion columns: room for their names would take hours.
TEST_F(Mat, WithColumnsButNoRowsIsRefusedAtOnce) {
  std::string bytes = Bytes("plain.mat");
  const std::int32_t rows = 0, columns = 2'000'000'000;
  std::memcpy(bytes.data() + 288 + 32, &rows, 4);  // of x, as above
  std::memcpy(bytes.data() + 288 + 36, &columns, 4);
  EXPECT_THAT([&] { Read(bytes, "x"); },
              ThrowsMessage<Error>(HasSubstr("log.mat: x: expected a matrix of numbers")));
}

TEST_F(Mat, CutOffAnywhereGivesAnErrorOrWhatIsWhole) {
  for (const char* name : {"plain.mat", "zipped.mat"}) {
    const std::string bytes = Bytes(name);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      try {
        const Columns c = Read(bytes.substr(0, size));
        for (const auto& values : c.values) EXPECT_EQ(values.size(), 4u) << name << " " << size;
      } catch (const Error& e) {
        EXPECT_THAT(e.what(), HasSubstr("log.mat"));
      }
    }
  }
}

}  // namespace
}  // namespace continuum
