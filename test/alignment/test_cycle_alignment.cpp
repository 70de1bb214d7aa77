#include <cmath>

#include <gtest/gtest.h>

#include "object_modelling/registration/pair_refinement.h"
#include "part_alignment.h"
#include "registration/made_part.h"

namespace object_modelling::alignment
{
namespace
{
using registration::X, registration::Y, registration::Z;
const Eigen::Vector3i BOX_COUNT(30, 40, 20);  // points along the edges of a box, 60 x 80 x 40 mm

/// A plain box about the origin, and two views of its face at z = -20 mm; beside it they saw what is far behind.
registration::PartialModel box()
{
  registration::PartialModel part = registration::madePart();
  const Eigen::Vector3f half = 0.5F * registration::SPACING_M * (BOX_COUNT.array() - 1).cast<float>();
  const Eigen::Vector3f axes[] = { X, Y, Z };
  for (int i = 0; i < 3; ++i)
    for (const bool far : { false, true })
    {
      const int u = (i + (far ? 1 : 2)) % 3, v = (i + (far ? 2 : 1)) % 3;
      Eigen::Vector3f corner = -half;
      corner[i] = far ? half[i] : -half[i];
      registration::addPatch(corner, axes[u], axes[v], BOX_COUNT[u], BOX_COUNT[v], registration::plain, &part);
    }
  registration::SpaceView view = registration::viewAlongZ(1.5F);
  // 5 mm are a pixel: the face, and one pixel round it.
  view.least_depth_m(cv::Rect(93, 91, 14, 18)) = 0.98F;
  part.views = { view, view };
  return part;
}

Eigen::Isometry3f turned(float angle_deg, const Eigen::Vector3f& axis)
{
  return registration::pose({ 0, 0, 0 }, angle_deg * static_cast<float>(M_PI) / 180, axis);
}

/// The pair found how the box lies, and judges a pose that others imply.
class ImpliedPoseOfABox : public testing::Test
{
protected:
  PairAlignment alsoAt(const Eigen::Isometry3f& implied) const
  {
    base::JobControl control;
    PairCandidate found;
    found.quality =
        registration::measurePair(registration::PartPair(part_, part_, 1), Eigen::Isometry3f::Identity(), true);
    return alignment::alsoAt(part_, part_, { found }, { implied.cast<double>() }, options_, control);
  }
  const registration::PartialModel box_ = box();
  const registration::MatchedSurface part_ = registration::MatchedSurface(box_, 1);
  const PairAlignmentOptions options_;
};

TEST_F(ImpliedPoseOfABox, IsMovedIntoPlaceAndAsGoodWhereItMakesTheSameObject)
{
  const PairAlignment pair = alsoAt(turned(177, Z));
  ASSERT_TRUE(pair.accepted) << pair.reason;
  ASSERT_EQ(pair.candidates.size(), 2u);
  const PairCandidate& implied = pair.candidates[pair.candidates[0].kind == ProposalKind::CYCLE ? 0 : 1];
  EXPECT_EQ(implied.kind, ProposalKind::CYCLE);
  EXPECT_LT(Eigen::AngleAxisf(implied.T_a_b.cast<float>().linear() * turned(180, Z).linear().transpose()).angle(),
            0.01);
  EXPECT_GT(implied.quality.probability, 0.85);
  EXPECT_GT(pair.candidates[0].same_object_probability * pair.candidates[1].same_object_probability, 0.85);
}

TEST_F(ImpliedPoseOfABox, IsImprobableWhereTheSurfacesContradictIt)
{
  const double alone = alsoAt(Eigen::Isometry3f::Identity()).candidates[0].quality.probability;
  for (const Eigen::Isometry3f& wrong : { turned(90, Z), turned(90, X), turned(45, Y) })
  {
    const PairAlignment pair = alsoAt(wrong);
    ASSERT_TRUE(pair.accepted) << pair.reason;
    EXPECT_EQ(pair.candidates[0].kind, ProposalKind::SHAPE);
    EXPECT_NEAR(pair.candidates[0].quality.probability, alone, 0.05);
    for (std::size_t i = 1; i < pair.candidates.size(); ++i)
      EXPECT_LT(pair.candidates[i].quality.probability, 0.05);
  }
}

TEST_F(ImpliedPoseOfABox, IsNotAddedTwice)
{
  const PairAlignment pair = alsoAt(turned(1, Z));
  ASSERT_EQ(pair.candidates.size(), 1u);
  EXPECT_EQ(pair.candidates[0].kind, ProposalKind::SHAPE) << "it was found";
}

}  // namespace
}  // namespace object_modelling::alignment
