#pragma once

#include <gtest/gtest.h>

#include "object_modelling/pipeline/record_session.h"
#include "object_modelling/pipeline/session_jobs.h"
#include "object_modelling/pipeline/session_refinement.h"
#include "recordings.h"
#include "support/temp_dir.h"
#include "support/transform_matchers.h"

namespace object_modelling::pipeline
{
using base::StatusCode;

constexpr int FRAMES = 24;
constexpr double TURN_RAD = 1.2;
constexpr char WALK[] = "walk";

/// Every test has its own copy of one recorded session.
class SessionJobs : public ::testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    recorded_ = std::make_unique<test_support::TempDir>();
    const auto store = keyframes::openSqlStore(recorded_->path("store.db"));
    MemorySource source(walkRoundBox(FRAMES, TURN_RAD));
    base::JobControl control;
    recordSession(source, named(WALK), store.get(), {}, control);
    store->exportSession(WALK, recorded_->path("walk.db"));
  }
  static void TearDownTestSuite() { recorded_.reset(); }

  void SetUp() override { store_->importSession(recorded_->path("walk.db")); }

  Eigen::Isometry3d trueT_session_camera(double stamp_s) const
  {
    const auto index = std::lround((stamp_s - recording_.frames[0].stamp_s) * 30);
    return recording_.T_object_cameras[0].inverse() * recording_.T_object_cameras.at(index);
  }
  double worstPosition_m(const std::string& session_id = WALK)
  {
    double worst_m = 0;
    for (const rgbd::Keyframe& keyframe : keyframes::loadKeyframes(*store_, session_id))
      worst_m = std::max(worst_m, (keyframe.T_session_camera.translation() -
                                   trueT_session_camera(keyframe.frame.stamp_s).translation())
                                      .norm());
    return worst_m;
  }
  int refinedObservationCount(const std::string& session_id = WALK)
  {
    const bundle_adjustment::BundleAdjustmentResult result = refineStoredSession(*store_, session_id, {}, control_);
    EXPECT_TRUE(result.status.ok()) << result.status.message;
    int count = 0;
    for (const bundle_adjustment::KeyframeResidual& residual : result.residuals)
      count += residual.observation_count;
    return count;
  }

  static inline std::unique_ptr<test_support::TempDir> recorded_;
  const Recording& recording_ = walkRoundBox(FRAMES, TURN_RAD);
  test_support::TempDir folder_;
  std::unique_ptr<keyframes::SessionStore> store_ = keyframes::openSqlStore(folder_.path("store.db"));
  base::JobControl control_;
};
}  // namespace object_modelling::pipeline
