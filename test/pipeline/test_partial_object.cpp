#include "build_fixture.h"
#include "object_modelling/pipeline/align_sessions.h"
#include "object_modelling/pipeline/partial_object.h"
#include "support/transform_matchers.h"

// Sessions that do not fit each other: an object all the same, said to be partial, and whole once a person decides.
namespace object_modelling::pipeline
{
using base::StatusCode;

namespace
{
constexpr char BALL[] = "a_ball";  // before "box" by name and in every list

test_support::SyntheticScene ballOnTable()
{
  test_support::SyntheticScene scene = test_support::boxOnTable();
  scene.objects = { test_support::standingSphere(0.12) };
  return scene;
}

bool has(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}

alignment::AlignmentEdge edge(const std::string& a, const std::string& b, double probability, bool accepted)
{
  alignment::PairCandidate candidate;
  candidate.quality.probability = probability;
  alignment::AlignmentEdge edge;
  edge.session_a = a;
  edge.session_b = b;
  edge.accepted = accepted;
  edge.reason = accepted ? "" : "too little";
  edge.candidates = { candidate };
  return edge;
}
}  // namespace

/// The store has a box and a ball, taken for one object.
class PartialObject : public BuildObject
{
protected:
  void SetUp() override
  {
    storeRenderedSession(*store_, BALL, 10, ballOnTable());
    BuildObject::SetUp();
  }
  alignment::AlignmentResult align(Required required)
  {
    AlignOptions options;
    options.required = required;
    return alignStoredSessions(*store_, { BALL, "box" }, options, control_);
  }
  BuildReport buildFrom(const alignment::AlignmentResult& aligned)
  {
    BuildOptions options = coarse();
    options.left_out = leftOutOf(aligned);
    return buildObject(*store_, database_, "carton", "", aligned.placements, options, control_);
  }
};

TEST_F(PartialObject, IsBuiltFromTheBestSessionAndWholeOnceAPersonAcceptsThePair)
{
  const alignment::AlignmentResult aligned = align(Required::ONE);
  ASSERT_TRUE(aligned.status.ok()) << aligned.status.message;
  ASSERT_EQ(aligned.placements.size(), 1u);
  EXPECT_EQ(aligned.placements[0].session_id, "box") << "which has more surface";
  EXPECT_EQ(aligned.left_out, std::vector<std::string>{ BALL });
  EXPECT_TRUE(has(aligned.status.message, "'box' is taken alone, since it saw most")) << aligned.status.message;

  const BuildReport partial = buildFrom(aligned);
  ASSERT_TRUE(partial.status.ok()) << partial.status.message;
  EXPECT_EQ(partial.status.message.find("PARTIAL: object 'carton' is built from 1 of its 2 sessions, without 'a_ball'"),
            0u)
      << partial.status.message;
  EXPECT_EQ(stagesOf(partial),
            (std::vector<std::string>{ "load", "fuse", "surface", "texture", "properties", "describe", "write" }))
      << "of one session there is no joint refinement";
  database::ObjectEntry entry = database_.entry("carton");
  EXPECT_TRUE(entry.partial);
  ASSERT_EQ(entry.sessions_left_out.size(), 1u);
  EXPECT_EQ(entry.sessions_left_out[0].id, BALL);
  EXPECT_TRUE(has(entry.sessions_left_out[0].reason, "with 'box': ")) << entry.sessions_left_out[0].reason;
  EXPECT_EQ(store_->session(BALL).object_id, "carton") << "or the next build of the object would forget it";
  EXPECT_FALSE(store_->session(BALL).T_model_session);
  const Eigen::Isometry3d T_model_box = *store_->session("box").T_model_session;

  ASSERT_NE(joiningPair(aligned), nullptr);
  acceptAlignment(*store_, "box", BALL, 0);
  const alignment::AlignmentResult accepted = align(Required::ALL);
  ASSERT_TRUE(accepted.status.ok()) << accepted.status.message;
  const BuildReport whole = buildFrom(accepted);
  ASSERT_TRUE(whole.status.ok()) << whole.status.message;
  EXPECT_FALSE(has(whole.status.message, "PARTIAL")) << whole.status.message;
  EXPECT_EQ(stagesOf(whole), (std::vector<std::string>{ "load", "joint refinement", "fuse", "surface", "texture",
                                                        "properties", "describe", "write" }));
  entry = database_.entry("carton");
  EXPECT_FALSE(entry.partial);
  EXPECT_EQ(entry.sessions.size(), 2u);
  EXPECT_TRANSFORM_NEAR(*store_->session("box").T_model_session, T_model_box, 1e-9, 1e-7);
  EXPECT_TRUE(store_->session(BALL).T_model_session);

  refuseAlignment(*store_, "box", BALL);
  ASSERT_TRUE(buildFrom(align(Required::ONE)).status.ok());
  EXPECT_FALSE(store_->session("box").T_model_session && store_->session(BALL).T_model_session);
  EXPECT_EQ(database_.check(), std::vector<std::string>());
}

TEST_F(PartialObject, IsAnErrorWhereAllAreRequired)
{
  for (const Required required : { Required::TWO, Required::ALL })
  {
    const alignment::AlignmentResult aligned = align(required);
    EXPECT_EQ(aligned.status.code, StatusCode::NO_RESULT);
    EXPECT_TRUE(aligned.placements.empty());
    EXPECT_EQ(aligned.left_out.size(), 2u);
  }
  EXPECT_FALSE(knownAlignment(*store_, "box", BALL).candidates.empty()) << "a person may still choose one";
}

TEST_F(PartialObject, KeepsTheFrameOfAModelThatIsThere)
{
  ASSERT_TRUE(build({ BALL }).status.ok());
  const Eigen::Isometry3d T_model_ball = *store_->session(BALL).T_model_session;
  const alignment::AlignmentResult aligned = align(Required::ONE);
  ASSERT_EQ(aligned.placements.size(), 1u);
  EXPECT_EQ(aligned.placements[0].session_id, BALL) << "though it has less surface";
  EXPECT_TRUE(has(aligned.status.message, "in a model already")) << aligned.status.message;
  const BuildReport report = buildFrom(aligned);
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  EXPECT_TRANSFORM_NEAR(*store_->session(BALL).T_model_session, T_model_ball, 1e-9, 1e-7);
}

TEST_F(PartialObject, RefusesLeftOutSessionsThatCannotBe)
{
  BuildOptions options = coarse();
  options.left_out = { { "box", "reason" } };
  EXPECT_EQ(build({ "box" }, options).status.code, StatusCode::INVALID_ARGUMENT);
  options.left_out = { { "missing", "reason" } };
  EXPECT_EQ(statusOf([&] { build({ "box" }, options); }).code, StatusCode::NOT_FOUND);
  EXPECT_TRUE(database_.list().empty());
}

TEST(PartialAlignment, RequiresAllAndSaysWhyNot)
{
  alignment::AlignmentResult aligned;
  aligned.status.message = "left out: 'c'";
  aligned.placements.resize(2);
  aligned.placements[0].session_id = "a";
  aligned.placements[1].session_id = "b";
  aligned.left_out = { "c" };
  aligned.edges = { edge("a", "b", 0.9, true), edge("a", "c", 0.1, false), edge("c", "b", 0.3, false) };

  const test_support::TempDir folder;
  const auto store = keyframes::openSqlStore(folder.path("store.db"));
  alignment::AlignmentResult strict = aligned;
  require(Required::ONE, *store, {}, &strict);
  EXPECT_TRUE(strict.status.ok()) << "two fit";
  EXPECT_EQ(strict.placements.size(), 2u);
  require(Required::ALL, *store, {}, &strict);
  EXPECT_EQ(strict.status.code, StatusCode::NO_RESULT);
  EXPECT_TRUE(has(strict.status.message, "required")) << strict.status.message;
  EXPECT_TRUE(has(strict.status.message, "left out: 'c'")) << strict.status.message;

  const std::vector<database::LeftOutSession> left_out = leftOutOf(aligned);
  ASSERT_EQ(left_out.size(), 1u);
  EXPECT_EQ(left_out[0].reason, "with 'a': too little; with 'b': too little");
  ASSERT_NE(joiningPair(aligned), nullptr);
  EXPECT_EQ(joiningPair(aligned)->session_b, "b") << "the more probable one";
  aligned.edges[1].candidates.clear();
  aligned.edges[2].candidates.clear();
  EXPECT_EQ(joiningPair(aligned), nullptr);
}

}  // namespace object_modelling::pipeline
