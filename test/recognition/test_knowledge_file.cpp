#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "object_modelling/base/atomic_file.h"
#include "object_modelling/recognition/recogniser.h"
#include "recognition_fixture.h"

namespace object_modelling::recognition
{
namespace
{
namespace fs = std::filesystem;

class KnowledgeFileTest : public ::testing::Test
{
protected:
  static void SetUpTestSuite() { model_ = std::make_unique<database::ObjectModel>(boxModel()); }
  static void TearDownTestSuite() { model_.reset(); }
  void SetUp() override { database_.write(*model_, control_); }

  LearntObject recall(std::size_t max_views = 3)
  {
    LearningOptions options;
    options.max_views = max_views;  // few, so that it takes little time
    return recallOrLearn(database_, database_.entry("box"), options, control_);
  }

  static std::unique_ptr<database::ObjectModel> model_;

  test_support::TempDir dir_;
  base::JobControl control_;
  database::ObjectDatabase database_{ dir_.path("objects"), true };
  std::string path_ = database::ObjectDatabase::derivedPath(database_.root(), "box", "knowledge.bin");
};
std::unique_ptr<database::ObjectModel> KnowledgeFileTest::model_;

TEST_F(KnowledgeFileTest, WhatIsRecalledFindsTheSame)
{
  const LearntObject learnt = recall(10);
  EXPECT_FALSE(learnt.recalled);
  EXPECT_TRUE(learnt.kept.ok()) << learnt.kept.message;
  const LearntObject recalled = recall(10);
  EXPECT_TRUE(recalled.recalled);
  EXPECT_EQ(recalled.knowledge->content_hash, learnt.knowledge->content_hash);
  EXPECT_TRUE(database_.check().empty()) << database_.check().front();

  const rgbd::Frame frame = noisyFrame(boxBesideAnother(1.4), lookingAtTable(0.3, 0.45));
  const std::vector<Detection> first = Recogniser({ learnt.knowledge }).recognise(frame);
  const std::vector<Detection> second = Recogniser({ recalled.knowledge }).recognise(frame);
  ASSERT_GE(first.size(), 1U);
  ASSERT_EQ(first.size(), second.size());
  EXPECT_EQ(first[0].confidence_ratio, second[0].confidence_ratio);
  EXPECT_TRUE(first[0].T_camera_model.matrix() == second[0].T_camera_model.matrix());
}

TEST_F(KnowledgeFileTest, OtherOptionsAndAnotherModelAreLearntAnew)
{
  recall();
  EXPECT_FALSE(recall(2).recalled);
  EXPECT_FALSE(recall().recalled) << "the file has the other options'";
  EXPECT_TRUE(recall().recalled);

  database::ObjectModel changed = *model_;
  changed.name = "another";
  database_.write(changed, control_);
  EXPECT_FALSE(recall().recalled);
}

TEST_F(KnowledgeFileTest, ADamagedFileIsLearntAnew)
{
  recall();
  const std::string bytes = base::readTextFile(path_);
  for (const std::size_t at : { std::size_t{ 0 }, std::size_t{ 40 }, bytes.size() / 2, bytes.size() - 1 })
  {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(~damaged[at]);
    base::writeTextFile(path_, damaged);
    EXPECT_FALSE(recall().recalled) << "byte " << at;
    EXPECT_EQ(base::readTextFile(path_), bytes) << "byte " << at;
  }
  for (const std::size_t size : { std::size_t{ 0 }, std::size_t{ 3 }, std::size_t{ 60 }, bytes.size() - 1 })
  {
    base::writeTextFile(path_, bytes.substr(0, size));
    EXPECT_FALSE(recall().recalled) << size << " bytes";
  }
}

TEST_F(KnowledgeFileTest, WhatCannotBeKeptWorksFromMemory)
{
  std::ofstream(fs::path(path_).parent_path()) << "no folder";
  const LearntObject learnt = recall();
  EXPECT_FALSE(learnt.recalled);
  ASSERT_TRUE(learnt.knowledge);
  EXPECT_GT(learnt.knowledge->descriptors.rows, 50);
  EXPECT_EQ(learnt.kept.code, base::StatusCode::STORAGE);
  EXPECT_NE(learnt.kept.message.find("'box'"), std::string::npos) << learnt.kept.message;
}

TEST_F(KnowledgeFileTest, OfAnObjectThatIsGoneNothingIsKept)
{
  const std::string hash = database_.entry("box").content_hash;
  bool written = false;
  const auto write = [&](const std::string&) { written = true; };
  EXPECT_FALSE(database_.keepDerived("box", "another hash", "knowledge.bin", write, control_));
  database_.remove("box");
  EXPECT_FALSE(database_.keepDerived("box", hash, "knowledge.bin", write, control_));
  EXPECT_FALSE(written);
  EXPECT_FALSE(fs::exists(database_.root() + "/box"));
}

}  // namespace
}  // namespace object_modelling::recognition
