#include <gtest/gtest.h>

#include "../../src/database/manifest.h"
#include "model_fixtures.h"
#include "object_modelling/base/atomic_file.h"
#include "object_modelling/database/object_database.h"
#include "support/temp_dir.h"

namespace object_modelling::database
{
namespace
{
const char REASON[] = "with 'first': overlap 3 % below 12 %; with \"second\": no # pose";

class PartialObjects : public ::testing::Test
{
protected:
  void write(const ObjectModel& model)
  {
    base::JobControl control;
    database_.write(model, control);
  }
  static ObjectModel partialModel()
  {
    ObjectModel model = makeModel("cereal", 0, 0);
    model.sessions_left_out = { { "third", REASON } };
    return model;
  }
  std::string path(const std::string& name) const { return database_.root() + "/" + name; }
  static void replace(const std::string& path, const std::string& from, const std::string& to)
  {
    std::string text = base::readTextFile(path);
    ASSERT_NE(text.find(from), std::string::npos) << path << " lacks " << from;
    base::writeTextFile(path, text.replace(text.find(from), from.size(), to));
  }
  std::string problems() const
  {
    std::string all;
    for (const std::string& problem : database_.check())
      all += problem + "\n";
    return all;
  }

  test_support::TempDir folder_;
  ObjectDatabase database_{ folder_.path("db"), true };
};
}  // namespace

TEST_F(PartialObjects, SayWhatTheyLackAndWhy)
{
  write(partialModel());
  const ObjectEntry entry = database_.entry("cereal");
  EXPECT_TRUE(entry.partial);
  ASSERT_EQ(entry.sessions_left_out.size(), 1u);
  EXPECT_EQ(entry.sessions_left_out[0].id, "third");
  EXPECT_EQ(entry.sessions_left_out[0].reason, REASON);
  EXPECT_TRUE(readManifest(path("manifest.yaml")).objects.at("cereal").partial);
  EXPECT_EQ(problems(), "");

  write(makeModel("cereal", 0, 0));
  EXPECT_FALSE(database_.entry("cereal").partial);
  EXPECT_TRUE(database_.entry("cereal").sessions_left_out.empty());
  EXPECT_FALSE(readManifest(path("manifest.yaml")).objects.at("cereal").partial);
  EXPECT_EQ(problems(), "");
}

TEST_F(PartialObjects, FilesFromBeforeAreRead)
{
  write(makeModel("cereal", 0, 0));
  const std::string hash = database_.entry("cereal").content_hash;
  replace(path("cereal/object.yaml"), "partial: false\nsessions_left_out:\n  []\n", "");
  replace(path("manifest.yaml"), "    partial: false\n", "");
  const ObjectEntry entry = database_.entry("cereal");
  EXPECT_FALSE(entry.partial);
  replace(path("manifest.yaml"), hash, entry.content_hash);
  EXPECT_EQ(problems(), "");
  write(makeModel("cup", 0, 0));
  EXPECT_EQ(problems(), "") << "the manifest is written anew";
}

TEST_F(PartialObjects, ChecksNameEveryContradiction)
{
  const auto has = [this](const std::string& part) { return problems().find(part) != std::string::npos; };
  write(partialModel());
  replace(path("manifest.yaml"), "partial: true", "partial: false");
  EXPECT_TRUE(has("partial is true, but false in manifest.yaml")) << problems();

  write(partialModel());
  replace(path("cereal/object.yaml"), "partial: true", "partial: false");
  EXPECT_TRUE(has("partial is false, but sessions_left_out has 1 sessions")) << problems();

  write(partialModel());
  replace(path("cereal/object.yaml"), "id: \"third\"", "id: \"first\"");
  EXPECT_TRUE(has("session 'first' is in sessions and in sessions_left_out")) << problems();

  write(partialModel());
  replace(path("cereal/object.yaml"), "partial: true", "partial: perhaps");
  EXPECT_TRUE(has("object.yaml does not describe an object")) << problems();
}

TEST_F(PartialObjects, AMendedManifestStillSaysSo)
{
  write(partialModel());
  write(makeModel("cup", 0, 0));
  // As a writer that died leaves it: the next one reads the folders.
  writeManifest(path(".object_modelling-manifest.yaml"), {});
  write(makeModel("cup", 1, 0));
  const Manifest manifest = readManifest(path("manifest.yaml"));
  EXPECT_TRUE(manifest.objects.at("cereal").partial);
  EXPECT_FALSE(manifest.objects.at("cup").partial);
  EXPECT_EQ(problems(), "");
}

}  // namespace object_modelling::database
