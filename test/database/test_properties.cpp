#include <gtest/gtest.h>

#include <filesystem>

#include "model_fixtures.h"
#include "object_modelling/base/atomic_file.h"
#include "object_modelling/database/mesh_evidence.h"
#include "object_modelling/database/object_database.h"
#include "object_modelling/mesh/mesh_files.h"
#include "support/temp_dir.h"

namespace object_modelling::database
{
namespace
{
namespace fs = std::filesystem;
using base::StatusCode;
using object_properties::ObjectProperties;

ObjectModel modelWithProperties()
{
  ObjectModel model = makeModel("cereal", 0, 1);
  model.T_support_model = { Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.1)) };
  model.mesh_sigmas_m.assign(8, 0.0004f);
  base::JobControl control;
  model.properties = object_properties::propertiesOf(model.mesh, model.T_support_model, {}, control);
  model.mesh.seen = { 1, 0, 1, 1, 1, 1, 1, 1 };  // both triangles of the bottom have the one that was not
  model.properties->unseen = object_properties::unseenOf(model.mesh, model.T_support_model[0]);
  return model;
}

void replaceIn(const std::string& path, const std::string& from, const std::string& to)
{
  std::string text = base::readTextFile(path);
  ASSERT_NE(text.find(from), std::string::npos) << from;
  base::writeTextFile(path, text.replace(text.find(from), from.size(), to));
}
}  // namespace

class Properties : public ::testing::Test
{
protected:
  Properties() : database_(folder_.path("db"), true) {}
  void write(const ObjectModel& model) { database_.write(model, control_); }
  std::string problems() const
  {
    std::string text;
    for (const std::string& problem : database_.check())
      text += problem + "\n";
    return text;
  }
  std::string yaml(const std::string& id = "cereal") const { return database_.root() + "/" + id + "/object.yaml"; }
  /// An object as written by version 1.
  void writeOld()
  {
    write(makeModel("cereal", 0, 1));
    replaceIn(yaml(), "schema_version: 2", "schema_version: 1");
    const std::string hash = database_.entry("cereal").content_hash;
    std::string manifest = base::readTextFile(database_.root() + "/manifest.yaml");
    const std::size_t at = manifest.find("content_hash: ") + 14;
    manifest.replace(at, 64, hash);
    base::writeTextFile(database_.root() + "/manifest.yaml", manifest);
  }

  test_support::TempDir folder_;
  ObjectDatabase database_;
  base::JobControl control_;
};

TEST_F(Properties, ComeBackAsWritten)
{
  const ObjectModel model = modelWithProperties();
  write(model);
  EXPECT_EQ(problems(), "");
  const ObjectEntry entry = database_.entry("cereal");
  EXPECT_EQ(entry.schema_version, 2);
  ASSERT_TRUE(entry.properties);
  const ObjectProperties &wrote = *model.properties, &read = *entry.properties;
  EXPECT_TRUE(read.mass.closed);
  EXPECT_EQ(read.mass.of, object_properties::Solid::MESH);
  EXPECT_EQ(read.mass.volume_m3, wrote.mass.volume_m3);
  EXPECT_EQ(read.mass.center_of_mass_m, wrote.mass.center_of_mass_m);
  EXPECT_EQ(read.mass.inertia_per_density_m5, wrote.mass.inertia_per_density_m5);
  EXPECT_EQ(read.mass.mass_kg, wrote.mass.mass_kg);
  ASSERT_EQ(read.resting_poses.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i)
  {
    EXPECT_EQ(read.resting_poses[i].T_support_model.matrix(), wrote.resting_poses[i].T_support_model.matrix());
    EXPECT_EQ(read.resting_poses[i].probability, wrote.resting_poses[i].probability);
    EXPECT_EQ(read.resting_poses[i].seen, wrote.resting_poses[i].seen);
  }
  ASSERT_EQ(read.symmetries.size(), wrote.symmetries.size());
  ASSERT_GE(read.symmetries.size(), 1u);
  EXPECT_EQ(read.symmetries[0].axis, wrote.symmetries[0].axis);
  EXPECT_EQ(read.symmetries[0].order, 2);
  ASSERT_TRUE(read.unseen);
  EXPECT_TRUE(read.unseen->bottom);
  ASSERT_EQ(entry.collision_paths.size(), 1u);
  EXPECT_EQ(mesh::readMesh(entry.collision_paths[0]).vertices.size(), 8u);
  EXPECT_EQ(mesh::readMesh(entry.mesh_path).seen, model.mesh.seen);
  const std::string mesh = base::readTextFile(entry.mesh_path);
  EXPECT_NE(mesh.find("property float sigma_m\nproperty uchar seen\n"), std::string::npos);
}

TEST_F(Properties, HaveTheDocumentedKeys)
{
  write(modelWithProperties());
  const std::string text = base::readTextFile(yaml());
  for (const char* key :
       { "mass_properties:\n  closed: true\n  of: mesh\n  volume_m3: ", "\n  center_of_mass_m: [",
         "\n  density_kg_m3: 500", "\n  inertia_per_density_m5: [",
         "\n  mass_kg: ", "resting_poses:\n  - support_from_model: [", "probability: ", "seen: true",
         "symmetries:\n  - of: shape\n    kind: discrete\n    axis: [", "point_m: [", "order: 2",
         "error_mm: ", "collision_parts: 1", "unseen:\n  ratio: ", "\n  bottom: true", "mesh/collision_00.ply: " })
    EXPECT_NE(text.find(key), std::string::npos) << key << "\n" << text;
}

TEST_F(Properties, FaultsAreNamed)
{
  const auto after = [&](const std::string& from, const std::string& to)
  {
    write(modelWithProperties());
    replaceIn(yaml(), from, to);
    return problems();
  };
  const auto has = [](const std::string& text, const std::string& part)
  { return text.find(part) != std::string::npos; };
  EXPECT_TRUE(has(after("seen: true", "probability: 0.9\n    seen: true"), "object.yaml"));
  EXPECT_TRUE(has(after("volume_m3: ", "volume_m3: -"), "volume and mass must not be negative"));
  EXPECT_TRUE(has(after("axis: [", "axis: [7, 0, 0]\n    unknown: ["), "unit length"));
  EXPECT_TRUE(has(after("collision_parts: 1", "collision_parts: 2"), "collision_01.ply, which it does not list"));
  EXPECT_TRUE(has(after("of: mesh", "of: cheese"), "mesh, closed_mesh or hull"));
  EXPECT_TRUE(has(after("order: 2", "order: 0"), "discrete with an order or continuous"));
  write(modelWithProperties());
  fs::remove(database_.root() + "/cereal/mesh/collision_00.ply");
  EXPECT_TRUE(has(problems(), "collision_00.ply is missing"));
}

TEST_F(Properties, ObjectsOfVersion1AreReadAndMigrated)
{
  writeOld();
  EXPECT_EQ(problems(), "");
  const ObjectEntry before = database_.entry("cereal");
  EXPECT_EQ(before.schema_version, 1);
  EXPECT_FALSE(before.properties);
  EXPECT_TRUE(before.collision_paths.empty());
  const std::map<std::string, std::string> files = contentsOf(database_.root() + "/cereal");

  EXPECT_TRUE(database_.migrate("cereal", control_));
  EXPECT_EQ(problems(), "");
  const ObjectEntry after = database_.entry("cereal");
  EXPECT_EQ(after.schema_version, 2);
  ASSERT_TRUE(after.properties);
  EXPECT_NEAR(after.properties->mass.volume_m3, 0.08 * 0.12 * 0.2, 1e-8);
  EXPECT_EQ(after.collision_paths.size(), 1u);
  EXPECT_EQ(after.name, before.name);
  EXPECT_EQ(after.quality.at("mean_sigma_m"), 0.00041);
  for (const auto& [file, content] : contentsOf(database_.root() + "/cereal"))
    if (file != "object.yaml" && file != "mesh/mesh.ply" && file != "mesh/collision_00.ply")
    {
      EXPECT_EQ(content, files.at(file)) << file;
    }
  EXPECT_FALSE(database_.migrate("cereal", control_));
  EXPECT_EQ(database_.entry("cereal").content_hash, after.content_hash);
}

TEST_F(Properties, AFailedMigrationChangesNothing)
{
  writeOld();
  fs::remove(database_.root() + "/cereal/cloud.pcd");
  const std::map<std::string, std::string> before = contentsOf(database_.root());
  EXPECT_EQ(statusOf([&] { database_.migrate("cereal", control_); }).code, StatusCode::NOT_FOUND);
  EXPECT_EQ(contentsOf(database_.root()), before);
  replaceIn(yaml(), "schema_version: 1", "schema_version: 3");
  EXPECT_EQ(statusOf([&] { database_.migrate("cereal", control_); }).code, StatusCode::STORAGE);
  EXPECT_EQ(statusOf([&] { database_.migrate("cup", control_); }).code, StatusCode::NOT_FOUND);
}

TEST_F(Properties, ObjectsCanBeRenamed)
{
  write(modelWithProperties());
  ObjectModel other = modelWithProperties();
  other.id = "cup";
  other.name = "cup";
  write(other);
  EXPECT_EQ(statusOf([&] { database_.rename("cereal", "cup"); }).code, StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(statusOf([&] { database_.rename("nothing", "new"); }).code, StatusCode::NOT_FOUND);
  EXPECT_EQ(statusOf([&] { database_.rename("cereal", "../x"); }).code, StatusCode::INVALID_ARGUMENT);
  database_.rename("cereal", "flakes");
  database_.rename("cup", "mug");
  EXPECT_EQ(problems(), "");
  ASSERT_EQ(database_.list().size(), 2u);
  EXPECT_EQ(database_.entry("flakes").name, modelWithProperties().name);
  EXPECT_EQ(database_.entry("mug").name, "mug");
  EXPECT_FALSE(fs::exists(database_.root() + "/cereal"));
}

TEST(MeshEvidence, FarFromFusedPointsNothingWasSeen)
{
  fusion::FusedCloud cloud;
  mesh::TriangleMesh mesh;
  for (int i = 0; i < 10; ++i)
  {
    mesh.vertices.emplace_back(0.01f * static_cast<float>(i), 0.f, 0.f);
    cloud.points.emplace_back(0.001f * static_cast<float>(i), 0.001f, 0.f);
    cloud.sigmas_m.push_back(0.0005f);
  }
  mesh.seen.assign(10, 1);
  mesh.seen[0] = 0;  // stays so
  markSeen(cloud, 0.004, &mesh);
  EXPECT_EQ(mesh.seen, (std::vector<std::uint8_t>{ 0, 1, 0, 0, 0, 0, 0, 0, 0, 0 }));
  const std::vector<float> sigmas_m = sigmasOf(cloud, mesh);
  EXPECT_NEAR(sigmas_m[1], 0.0005f, 1e-7f);
  EXPECT_TRUE(std::isnan(sigmas_m[0]));
  EXPECT_TRUE(sigmasOf({}, mesh).empty());
}

}  // namespace object_modelling::database
