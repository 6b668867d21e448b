#include "sim/film/film.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/film/film_recipe.h"
#include "sim/model/model_spec.h"
#include "sim/model/mujoco_handles.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using ::testing::FloatNear;

// A ball of 2 kg on a slide turned a quarter about y, under a cable of 3 N; gravity pulls aside.
constexpr char kModel[] = R"(<mujoco>
  <option gravity="3 0 0"/>
  <worldbody>
    <site name="top" pos="0 0 1"/>
    <body euler="0 90 0">
      <joint type="slide" axis="-1 0 0"/>
      <geom size="0.1" mass="2"/>
      <site name="middle"/>
      <site name="beside" pos="0 0.2 0.1"/>
    </body>
  </worldbody>
  <tendon><spatial name="cable" width="0.01"><site site="top"/><site site="middle"/></spatial></tendon>
  <actuator><motor tendon="cable" gear="-1" ctrlrange="0 10"/></actuator>
  <sensor><force name="force" site="middle"/><torque name="torque" site="beside"/></sensor>
</mujoco>
)";

class Decorated : public ::testing::Test {
 protected:
  Decorated() {
    mjVFS files;
    mj_defaultVFS(&files);
    mj_addBufferVFS(&files, "model.xml", kModel, sizeof kModel - 1);
    char error[300] = "";
    model_.reset(mj_loadXML("model.xml", &files, error, sizeof error));
    mj_deleteVFS(&files);
    EXPECT_TRUE(model_) << error;
    data_.reset(mj_makeData(model_.get()));
    data_->ctrl[0] = 3;
    mj_forward(model_.get(), data_.get());
    mjv_defaultScene(&scene_);
    mjv_makeScene(model_.get(), &scene_, 100);
    mjvOption option;
    mjv_defaultOption(&option);
    mjvCamera camera;
    mjv_defaultCamera(&camera);
    mjv_updateScene(model_.get(), data_.get(), &option, nullptr, &camera, mjCAT_ALL, &scene_);
  }
  ~Decorated() override { mjv_freeScene(&scene_); }

  const mjvGeom* Find(auto&& wanted) const {
    const mjvGeom *const begin = scene_.geoms, *const end = begin + scene_.ngeom;
    const mjvGeom* const found = std::find_if(begin, end, wanted);
    return found == end ? nullptr : found;
  }

  Owned<mjModel> model_;
  Owned<mjData> data_;
  mjvScene scene_;
};

TEST_F(Decorated, TendonsTakeTheColourOfTheirTension) {
  FilmOptions options;
  options.tension = {1, 5};
  Decorate(options, *model_, *data_, scene_);
  const mjvGeom* const cable = Find([](const mjvGeom& g) { return g.objtype == mjOBJ_TENDON; });
  ASSERT_TRUE(cable);
  const ColorBar bar;
  for (int c = 0; c < 3; ++c)
    EXPECT_THAT(cable->rgba[c], FloatNear((bar.from[c] + bar.to[c]) / 2, 1e-6F));
}

TEST(Outlook, RangeOfTheTensionIsRoundAndHoldsNought) {
  Outlook ahead;
  ahead.Include(std::vector<std::optional<double>>{std::nullopt});
  EXPECT_FALSE(ahead.tension);
  ahead.Include(std::vector<std::optional<double>>{3.2, std::nullopt, 0.7});
  EXPECT_EQ(ahead.tension, (std::array{0.0, 4.0}));
  Outlook other;
  other.Include(std::vector<std::optional<double>>{-11.0, 1.0});
  other.Include(ahead);
  EXPECT_EQ(other.tension, (std::array{-15.0, 4.0}));
}

// A cable over a corner at 60 N, which a load draws out: 60 e^(0.2 pi/2) = 82 N behind the corner.
TEST(Outlook, OfCablesWithFrictionEndsAboveTheLargestTension) {
  const testing::Scratch files;
  files.Write("crane.xml", R"(<mujoco><extension><plugin plugin="continuum.capstan">
      <instance name="i"><config key="tendon" value="cable"/><config key="mu" value="0.2"/></instance>
    </plugin></extension><worldbody><site name="a" pos="-1 0 1"/><site name="b" pos="0 0 1"/>
      <body><joint type="slide" axis="0 0 1" damping="100"/><geom size=".05" mass="10"/>
        <site name="c"/></body></worldbody>
    <tendon><spatial name="cable"><site site="a"/><site site="b"/><site site="c"/></spatial></tendon>
    <actuator><motor name="m" tendon="cable" gear="-1"/></actuator></mujoco>)");
  const Clip clip =
      Clip::Read(files.Write("clip.yaml",
                             "model: crane.xml\ncamera: {azimuth: 90, elevation: 0}\nseconds: "
                             "0.3\ncaption: c\ninputs: {m: [[0, 60], [1, 60]]}\n"));
  const Experiment& e = clip.experiment;
  const Outlook ahead = LookAhead(e, ModelSpec::Load(e.model), e.logs[0], clip.film);
  EXPECT_EQ(ahead.tension, (std::array{0.0, 100.0}));
}

TEST_F(Decorated, AnArrowPointsAlongTheForceInTheWorld) {
  ASSERT_NEAR(std::abs(data_->sensordata[2]), 6, 1e-9);  // z of the site is x of the world
  FilmOptions options;
  options.arrows = {{"force", 0.5, {0, 1, 0}}};
  Decorate(options, *model_, *data_, scene_);
  const mjvGeom* const arrow = Find([](const mjvGeom& g) { return g.type == mjGEOM_ARROW; });
  ASSERT_TRUE(arrow);
  EXPECT_NEAR(arrow->size[2], 2 * 3, 1e-6);  // drawn half as long: seen beside boxes
  EXPECT_NEAR(arrow->mat[2], std::copysign(1, data_->sensordata[2]), 1e-6);
}

// By the right hand: seen against the axis it runs counter-clockwise, as long as the torque.
TEST_F(Decorated, ABentArrowRunsAroundTheTorqueInTheWorld) {
  const int sensor = mj_name2id(model_.get(), mjOBJ_SENSOR, "torque");
  const int site = model_->sensor_objid[sensor];
  const double* const torque = data_->sensordata + model_->sensor_adr[sensor];
  double axis[3];
  mju_mulMatVec3(axis, data_->site_xmat + 9 * site, torque);
  const double size = mju_normalize3(axis);
  ASSERT_GT(size, 0.1);
  FilmOptions options;
  options.arrows = {{"torque", 0.2 / size, {0, 1, 0}, "", 0.1}};
  const int before = scene_.ngeom;
  Decorate(options, *model_, *data_, scene_);
  double length = 0;
  for (int g = before; g < scene_.ngeom; ++g) {
    const mjvGeom& geom = scene_.geoms[g];
    const bool head = geom.type == mjGEOM_ARROW;
    length += (head ? 0.5 : 2) * geom.size[2];
    double out[3], along[3], around[3];
    for (int i = 0; i < 3; ++i) {
      out[i] = geom.pos[i] - data_->site_xpos[3 * site + i];
      along[i] = geom.mat[3 * i + 2];
    }
    EXPECT_NEAR(mju_norm3(out), 0.1, 2e-3);
    EXPECT_NEAR(mju_dot3(out, axis), 0, 1e-6);
    mju_cross(around, axis, out);
    EXPECT_GT(mju_dot3(around, along), 0.096);
  }
  EXPECT_NEAR(length, 0.2, 2e-3);
}

TEST_F(Decorated, WhatIsMeasuredIsABallWithALineAndWhatIsHeldAPaleBall) {
  const int before = scene_.ngeom;
  DrawMeasured({{0, 0, 1}, {0, 0, 0.9}}, *model_, scene_);
  ASSERT_EQ(scene_.ngeom, before + 2);
  EXPECT_EQ(scene_.geoms[before].type, mjGEOM_SPHERE);
  EXPECT_EQ(scene_.geoms[before].rgba[3], 1);
  EXPECT_EQ(scene_.geoms[before + 1].type, mjGEOM_CAPSULE);
  DrawMeasured({{0, 0, 1}, {0, 0, 0.9}, true}, *model_, scene_);
  ASSERT_EQ(scene_.ngeom, before + 3);
  EXPECT_EQ(scene_.geoms[before + 2].type, mjGEOM_SPHERE);
  EXPECT_LT(scene_.geoms[before + 2].rgba[3], 0.5);
}

}  // namespace
}  // namespace continuum
