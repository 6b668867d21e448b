#include "sim/model/model_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using ::testing::ElementsAre;
using testing::Scratch;

class ModelFiles : public ::testing::Test {
 protected:
  std::vector<std::string> Of(const std::string& model) const {
    std::vector<std::string> names;
    for (const auto& file : FilesOfModel(scratch_ / model))
      names.push_back(file.lexically_relative(scratch_.folder()).string());
    return names;
  }
  Scratch scratch_;
};

TEST_F(ModelFiles, AreThoseItIncludesEachOnce) {
  scratch_.Write("a.xml", "<mujoco><include file='b.xml'/><include file='c.xml'/></mujoco>");
  scratch_.Write("b.xml", "<mujoco><include file='c.xml'/></mujoco>");
  scratch_.Write("c.xml", "<mujoco/>");
  EXPECT_THAT(Of("a.xml"), ElementsAre("a.xml", "b.xml", "c.xml"));
}

TEST_F(ModelFiles, AreMeshesAndTexturesOfTheirFolders) {
  std::filesystem::create_directories(scratch_ / "mesh");
  scratch_.Write("mesh/part.stl", "");
  scratch_.Write("wall.png", "");
  scratch_.Write("a.xml",
                 "<mujoco><compiler meshdir='mesh'/><asset><mesh file='part.stl'/>"
                 "<texture fileright='wall.png'/><mesh file='none.stl'/></asset></mujoco>");
  EXPECT_THAT(Of("a.xml"), ElementsAre("a.xml", "mesh/part.stl", "wall.png"));
}

TEST_F(ModelFiles, OfAModelThatIsMissingIsAnError) { EXPECT_THROW(Of("a.xml"), Error); }

}  // namespace
}  // namespace continuum
