#include "sim/io/sha256.h"

#include <gtest/gtest.h>

#include "error.h"
#include "support/scratch.h"

namespace continuum {
namespace {

// Examples of NIST for FIPS 180-4, and the empty text.
TEST(Sha256, IsThatOfThePublishedExamples) {
  EXPECT_EQ(Sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(Sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(Sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(Sha256(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

// The padding begins in the same block, or makes one of its own.
TEST(Sha256, DiffersForEveryLengthAboutABlock) {
  std::set<std::string> all;
  for (std::size_t length = 0; length < 200; ++length) all.insert(Sha256(std::string(length, 'x')));
  EXPECT_EQ(all.size(), 200);
}

TEST(Sha256, OfAFileIsThatOfItsBytes) {
  const testing::Scratch scratch;
  EXPECT_EQ(Sha256OfFile(scratch.Write("a", "abc")), Sha256("abc"));
  EXPECT_THROW(Sha256OfFile(scratch / "none"), Error);
}

}  // namespace
}  // namespace continuum
