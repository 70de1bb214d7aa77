#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "../../src/database/content_hash.h"
#include "model_fixtures.h"
#include "object_modelling/base/atomic_file.h"
#include "object_modelling/database/object_database.h"
#include "object_modelling/mesh/mesh_files.h"
#include "object_modelling/mesh/textured_mesh_files.h"
#include "support/temp_dir.h"

namespace object_modelling::database
{
namespace fs = std::filesystem;
using base::StatusCode;

class ObjectDatabaseTest : public ::testing::Test
{
protected:
  ObjectDatabaseTest() : database_(folder_.path("db"), true) {}
  std::string write(const ObjectModel& model)
  {
    base::JobControl control;
    return database_.write(model, control);
  }

  test_support::TempDir folder_;
  ObjectDatabase database_;
};

TEST_F(ObjectDatabaseTest, StartsEmptyAndSound)
{
  EXPECT_TRUE(database_.list().empty());
  EXPECT_TRUE(database_.check().empty());
  EXPECT_TRUE(ObjectDatabase(folder_.path("db/"), false).list().empty());
  EXPECT_EQ(statusOf([&] { ObjectDatabase(folder_.path("none"), false); }).code, StatusCode::NOT_FOUND);
  EXPECT_EQ(statusOf([&] { ObjectDatabase(folder_.path(), false); }).code, StatusCode::NOT_FOUND);
}

TEST_F(ObjectDatabaseTest, ListsWhatWasWritten)
{
  const ObjectModel model = makeModel("cereal");
  const std::string object = write(model);
  EXPECT_EQ(object, database_.root() + "/cereal");
  write(makeModel("box.2"));
  ASSERT_EQ(database_.list().size(), 2u);
  EXPECT_EQ(database_.list()[0].id, "box.2");
  const ObjectEntry entry = ObjectDatabase(folder_.path("db"), false).entry("cereal");
  EXPECT_EQ(entry.name, model.name);
  EXPECT_EQ(entry.size_m, model.box_model.size_m);
  EXPECT_EQ(entry.diameter_m, model.diameter_m);
  ASSERT_EQ(entry.sessions.size(), 2u);
  EXPECT_EQ(entry.sessions[0].id, "first");
  EXPECT_EQ(entry.sessions[0].keyframe_count, 2);
  EXPECT_EQ(entry.sessions[0].T_model_session.matrix(), model.sessions[0].T_model_session.matrix());
  EXPECT_EQ(entry.quality.at("mean_sigma_m"), 0.00041);
  EXPECT_TRUE(std::isnan(entry.quality.at("residual_px")));
  EXPECT_EQ(entry.mesh_path, object + "/mesh/mesh.ply");
  EXPECT_EQ(entry.content_hash, hashOfFile(object + "/object.yaml"));
  EXPECT_EQ(mesh::readMesh(entry.mesh_path).triangles.size(), model.mesh.triangles.size());
  EXPECT_TRUE(database_.check().empty());
}

TEST_F(ObjectDatabaseTest, HasTheDocumentedFiles)
{
  const std::map<std::string, std::string> files = contentsOf(write(makeModel("cereal")));
  std::vector<std::string> names;
  for (const auto& [name, content] : files)
    names.push_back(name);
  EXPECT_EQ(names, (std::vector<std::string>{ "cloud.pcd", "mesh/mesh.obj", "mesh/mesh.ply", "object.yaml",
                                              "preview.png", "views/cloud_00000000.pcd", "views/cloud_00000001.pcd",
                                              "views/image_00000000.jpg", "views/image_00000001.jpg",
                                              "views/object_indices_00000000.txt", "views/object_indices_00000001.txt",
                                              "views/pose_00000000.txt", "views/pose_00000001.txt" }));
  for (const char* text : { "unit: metre", "handedness: right", "model_from_session:", "support_from_model:", "size_m:",
                            "diameter_m:", "fx_px: 525", "version: 1.10", "session: \"first\"" })
    EXPECT_NE(files.at("object.yaml").find(text), std::string::npos) << text;
  const cv::Mat preview = cv::imread(database_.root() + "/cereal/preview.png");
  EXPECT_EQ(cv::norm(preview, makeModel("x").preview_bgr, cv::NORM_INF), 0);
}

TEST_F(ObjectDatabaseTest, HoldsTheTexture)
{
  ObjectModel model = makeModel("cereal");
  model.textured.mesh = model.mesh;
  model.textured.uvs.assign(model.mesh.triangles.size(),
                            { Eigen::Vector2f(0.1f, 0.2f), Eigen::Vector2f(0.9f, 0.2f), Eigen::Vector2f(0.5f, 0.8f) });
  model.textured.texture_bgr = cv::Mat(16, 20, CV_8UC3, cv::Scalar(10, 200, 90));
  model.textured.seen = cv::Mat(16, 20, CV_8UC1, cv::Scalar(255));
  const std::string folder = write(model) + "/mesh/";
  for (const std::string name : { "textured.obj", "textured.glb" })
  {
    const mesh::TexturedMesh back = mesh::readTexturedMesh(folder + name);
    EXPECT_EQ(back.mesh.triangles.size(), model.mesh.triangles.size()) << name;
    EXPECT_EQ(cv::norm(back.texture_bgr, model.textured.texture_bgr, cv::NORM_INF), 0) << name;
  }
  EXPECT_EQ(cv::imread(folder + "textured_seen.png", cv::IMREAD_GRAYSCALE).size(), cv::Size(20, 16));
  EXPECT_EQ(database_.check(), std::vector<std::string>());
  std::filesystem::remove(folder + "textured.mtl");
  EXPECT_EQ(database_.check().size(), 1u);
}

TEST_F(ObjectDatabaseTest, SameModelSameBytes)
{
  const ObjectDatabase other(folder_.path("other"), true);
  write(makeModel("cereal"));
  base::JobControl control;
  ObjectDatabase(other).write(makeModel("cereal"), control);
  EXPECT_EQ(contentsOf(database_.root()), contentsOf(other.root()));
}

TEST_F(ObjectDatabaseTest, ReplacesWholeObjects)
{
  write(makeModel("cereal", 0, 2));
  const std::string before = database_.entry("cereal").content_hash;
  write(makeModel("cereal", 1, 1));
  EXPECT_NE(database_.entry("cereal").content_hash, before);
  EXPECT_EQ(contentsOf(database_.root() + "/cereal").count("views/pose_00000001.txt"), 0u);
  EXPECT_TRUE(database_.check().empty());
  std::size_t entries = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(database_.root()))
    entries += entry.path().filename() != ".lock";
  EXPECT_EQ(entries, 2u);  // manifest and object: nothing temporary
}

TEST_F(ObjectDatabaseTest, RemovesObjects)
{
  write(makeModel("cereal"));
  write(makeModel("cup"));
  database_.remove("cereal");
  EXPECT_EQ(database_.list().size(), 1u);
  EXPECT_FALSE(fs::exists(database_.root() + "/cereal"));
  EXPECT_EQ(statusOf([&] { database_.remove("cereal"); }).code, StatusCode::NOT_FOUND);
  EXPECT_EQ(statusOf([&] { database_.entry("cereal"); }).code, StatusCode::NOT_FOUND);
  EXPECT_TRUE(database_.check().empty());
}

TEST_F(ObjectDatabaseTest, RefusesHostileIds)
{
  for (const std::string& id : { std::string("../x"), std::string(), std::string(65, 'x'), std::string(".hidden"),
                                 std::string("a/b"), std::string("exports"), std::string("manifest.yaml") })
  {
    EXPECT_EQ(statusOf([&] { write(makeModel(id, 0, 0)); }).code, StatusCode::INVALID_ARGUMENT) << id;
    EXPECT_EQ(statusOf([&] { database_.entry(id); }).code, StatusCode::INVALID_ARGUMENT) << id;
    EXPECT_EQ(statusOf([&] { database_.remove(id); }).code, StatusCode::INVALID_ARGUMENT) << id;
  }
  EXPECT_TRUE(database_.list().empty());
}

TEST_F(ObjectDatabaseTest, RefusesModelsThatAreNotWhole)
{
  const auto refused = [&](const std::function<void(ObjectModel*)>& spoil)
  {
    ObjectModel model = makeModel("cereal", 0, 1);
    spoil(&model);
    const base::Status status = statusOf([&] { write(model); });
    return status.code == StatusCode::INVALID_ARGUMENT && mentions(status, "cereal");
  };
  EXPECT_TRUE(refused([](ObjectModel* m) { m->mesh.triangles.clear(); }));
  EXPECT_TRUE(refused([](ObjectModel* m) { m->cloud.weights.pop_back(); }));
  EXPECT_TRUE(refused([](ObjectModel* m) { m->diameter_m = std::nan(""); }));
  EXPECT_TRUE(refused([](ObjectModel* m) { m->sessions[0].T_model_session(0, 3) = std::nan(""); }));
  EXPECT_TRUE(refused([](ObjectModel* m) { m->views[0].frame.camera.width = 7; }));
  EXPECT_TRUE(refused([](ObjectModel* m) { m->views[0].frame.object_mask = cv::Mat::ones(3, 3, CV_8UC1); }));
  EXPECT_TRUE(refused([](ObjectModel* m) { m->views[0].T_world_camera(0, 0) = INFINITY; }));
  EXPECT_TRUE(refused([](ObjectModel* m) { m->preview_bgr = cv::Mat::ones(3, 3, CV_8UC1); }));
  EXPECT_TRUE(database_.list().empty());
  EXPECT_TRUE(database_.check().empty());
}

TEST_F(ObjectDatabaseTest, ReportsProgressAndCancels)
{
  write(makeModel("cereal", 0, 2));
  const std::map<std::string, std::string> before = contentsOf(database_.root());
  std::vector<std::size_t> done;
  base::JobControl* running = nullptr;
  base::JobControl control(
      [&](const base::Progress& progress)
      {
        done.push_back(progress.done);
        EXPECT_EQ(progress.total, 5u);
        if (progress.done == 3)
          running->cancel();
      });
  running = &control;
  EXPECT_EQ(statusOf([&] { database_.write(makeModel("cereal", 1, 3), control); }).code, StatusCode::CANCELLED);
  EXPECT_EQ(done, (std::vector<std::size_t>{ 0, 1, 2, 3 }));
  EXPECT_EQ(contentsOf(database_.root()), before);
}

TEST_F(ObjectDatabaseTest, ChecksNameEveryFault)
{
  const std::string object = write(makeModel("cereal", 0, 0));
  const auto problemsAfter = [&](const std::function<void()>& spoil)
  {
    write(makeModel("cereal", 0, 0));
    spoil();
    std::string all;
    for (const std::string& problem : database_.check())
      all += problem + "\n";
    return all;
  };
  const auto has = [](const std::string& text, const std::string& part)
  { return text.find(part) != std::string::npos; };
  const auto edit = [](const std::string& path, const std::string& from, const std::string& to)
  {
    std::string text = base::readTextFile(path);
    ASSERT_NE(text.find(from), std::string::npos);
    base::writeTextFile(path, text.replace(text.find(from), from.size(), to));
  };
  const std::string yaml = object + "/object.yaml", manifest = database_.root() + "/manifest.yaml";
  EXPECT_TRUE(has(problemsAfter([&] { fs::remove(object + "/cloud.pcd"); }), "cloud.pcd is missing"));
  EXPECT_TRUE(has(problemsAfter([&] { base::writeTextFile(object + "/mesh/mesh.obj", "v 0 0 0\n"); }),
                  "mesh.obj has been changed"));
  EXPECT_TRUE(has(problemsAfter([&] { base::writeTextFile(object + "/notes.txt", ""); }), "notes.txt is not listed"));
  const std::string unit = problemsAfter([&] { edit(yaml, "unit: metre", "unit: millimetre"); });
  EXPECT_TRUE(has(unit, "unit is 'millimetre'") && has(unit, "object.yaml has been changed")) << unit;
  EXPECT_TRUE(has(problemsAfter([&] { edit(yaml, "handedness: right", "handedness: left"); }), "'left'"));
  EXPECT_TRUE(has(problemsAfter([&] { edit(yaml, "[0, 0, 0, 1]", "[0, 0, 0, 2]"); }), "transform"));
  EXPECT_TRUE(has(problemsAfter([&] { edit(yaml, "id: \"cereal\"", "id: \"cup\""); }), "folder is 'cereal'"));
  EXPECT_TRUE(has(problemsAfter([&] { base::writeTextFile(yaml, "{ not yaml"); }), "object.yaml cannot be read"));
  EXPECT_TRUE(has(problemsAfter([&] { fs::remove(yaml); }), "object.yaml"));
  EXPECT_TRUE(has(problemsAfter([&] { fs::remove_all(object); }), "cereal is missing"));
  EXPECT_TRUE(has(problemsAfter([&] { fs::create_directory(database_.root() + "/stray"); }), "stray is a folder"));
  fs::remove(database_.root() + "/stray");
  EXPECT_EQ(problemsAfter(
                [&]
                {
                  fs::create_directory(object + "/recognition");
                  base::writeTextFile(object + "/recognition/features", "derived");
                  fs::create_directory(database_.root() + "/exports");
                }),
            "");
  EXPECT_TRUE(has(problemsAfter([&] { edit(manifest, "unit: metre", "unit: inch"); }), "unit is 'inch'"));
  EXPECT_TRUE(has(problemsAfter([&] { base::writeTextFile(manifest, "objects: 3"); }), "manifest.yaml"));
}

TEST_F(ObjectDatabaseTest, OneBrokenObjectDoesNotHideTheOthers)
{
  write(makeModel("cereal"));
  write(makeModel("cup"));
  base::writeTextFile(database_.root() + "/cereal/object.yaml", "schema_version: 1\n");
  ASSERT_EQ(database_.list().size(), 1u);
  EXPECT_EQ(database_.list()[0].id, "cup");
  EXPECT_EQ(statusOf([&] { database_.entry("cereal"); }).code, StatusCode::BAD_INPUT);
}

TEST_F(ObjectDatabaseTest, RefusesANewerSchemaAndHostileManifests)
{
  const std::string manifest = database_.root() + "/manifest.yaml";
  base::writeTextFile(manifest, "schema_version: 42\n");
  base::Status status = statusOf([&] { ObjectDatabase(folder_.path("db"), true); });
  EXPECT_EQ(status.code, StatusCode::STORAGE);
  EXPECT_TRUE(mentions(status, "42") && mentions(status, "up to 2") && mentions(status, manifest)) << status.message;
  EXPECT_EQ(statusOf([&] { write(makeModel("cereal", 0, 0)); }).code, StatusCode::STORAGE);
  base::writeTextFile(manifest,
                      "schema_version: 1\nunit: metre\nhandedness: right\nobjects:\n"
                      "  - {id: ../../etc, content_hash: 0}\n");
  EXPECT_EQ(statusOf([&] { ObjectDatabase(folder_.path("db"), false); }).code, StatusCode::BAD_INPUT);
}

TEST(ContentHash, IsSha256)
{
  EXPECT_EQ(hashOfText("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  const test_support::TempDir folder;
  base::writeTextFile(folder.path("x"), "abc");
  EXPECT_EQ(hashOfFile(folder.path("x")), hashOfText("abc"));
  EXPECT_EQ(statusOf([&] { hashOfFile(folder.path("y")); }).code, StatusCode::NOT_FOUND);
}

TEST_F(ObjectDatabaseTest, TheReportIsCheckedButNotPartOfTheContent)
{
  ObjectModel model = makeModel("cereal");
  const std::string folder = write(model);
  const std::string hash = database_.entry("cereal").content_hash;
  EXPECT_FALSE(fs::exists(folder + "/report.sha256"));

  base::JobControl control;
  model.quality_yaml = "schema_version: 1\n";
  const auto make = [](const std::string& at)
  { base::writeTextFile(at + "/report.html", fs::exists(at + "/object.yaml") ? "whole" : ""); };
  database_.write(model, control, make);
  EXPECT_EQ(base::readTextFile(folder + "/report.html"), "whole");
  EXPECT_EQ(database_.check(), std::vector<std::string>());
  EXPECT_EQ(database_.entry("cereal").content_hash, hash);

  base::writeTextFile(folder + "/quality.yaml", "schema_version: 2\n");
  fs::remove(folder + "/report.html");
  const std::vector<std::string> problems = database_.check();
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_NE(problems[0].find("quality.yaml has been changed"), std::string::npos);
  EXPECT_NE(problems[1].find("report.html is missing"), std::string::npos);
  database_.remakeReport("cereal", control, make);
  EXPECT_EQ(database_.check(), std::vector<std::string>());
  fs::remove(folder + "/report.sha256");
  EXPECT_EQ(database_.check().size(), 2u);

  EXPECT_EQ(statusOf([&] { database_.remakeReport("nothing", control, make); }).code, StatusCode::NOT_FOUND);
  const auto fail = [](const std::string&) { throw base::Error(StatusCode::INTERNAL, "no report"); };
  EXPECT_TRUE(mentions(statusOf([&] { database_.write(makeModel("cereal", 1), control, fail); }), "no report"));
  EXPECT_EQ(database_.entry("cereal").content_hash, hash);
}

}  // namespace object_modelling::database
