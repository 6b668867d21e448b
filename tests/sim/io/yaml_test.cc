#include "sim/io/yaml.h"

#include <gmock/gmock.h>

#include "error.h"

namespace continuum {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string Message(const std::string& text) {
  try {
    Yaml::Parse(text, "a.yaml");
  } catch (const Error& e) {
    EXPECT_EQ(e.exit_code(), 2);
    return e.what();
  }
  return "no error";
}

TEST(Yaml, RefusesAKeyGivenTwiceAtAnyDepth) {
  EXPECT_THAT(Message("a: 1\nb: 2\na: 3\n"), AllOf(HasSubstr("a.yaml:3"), HasSubstr("'a' twice")));
  EXPECT_THAT(Message("a: [0, {b: 1, c: 2,\n  b: 3}]\n"),
              AllOf(HasSubstr("a.yaml:2"), HasSubstr("'b' twice"), HasSubstr("line 1")));
  EXPECT_THAT(Message("a:\n  - b: 1\n    \"b\": 2\n"), HasSubstr("a.yaml:3"));
}

TEST(Yaml, TakesTheSameKeyInDifferentMapsAndAsAValue) {
  EXPECT_EQ(Message("a: {a: a, b: [a, a]}\nb: {a: 1}\nc: [{a: 1}, {a: 2}]\n"), "no error");
  EXPECT_EQ(Message("x: &x {a: 1}\ny: *x\nz: *x\n? [a, a]\n: a\na: ~\n"), "no error");
}

TEST(Yaml, QuantityHasNoOtherKeys) {
  const Yaml robot = Yaml::Parse(
      "E: {value: 1, unit: Pa, uncertainty: 2, source: s}\nF: {value: 1, vlaue: 2}\n", "a.yaml");
  EXPECT_EQ(robot.At("E").Parameter(), 1);
  EXPECT_THROW(robot.At("F").Parameter(), Error);
}

}  // namespace
}  // namespace continuum
