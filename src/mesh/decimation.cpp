#include "object_modelling/mesh/decimation.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModHausdorffT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include "object_modelling/base/options.h"

namespace object_modelling::mesh
{
namespace
{
constexpr float MAX_TURN_DEG = 45;  // of a triangle's normal by one collapse

using Mesh = OpenMesh::TriMesh_ArrayKernelT<>;

Mesh toOpenMesh(const TriangleMesh& mesh, const OpenMesh::VPropHandleT<std::uint32_t>& index, Mesh result)
{
  std::vector<Mesh::VertexHandle> handles;
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i)
  {
    const Eigen::Vector3f& p = mesh.vertices[i];
    handles.push_back(result.add_vertex({ p.x(), p.y(), p.z() }));
    result.property(index, handles.back()) = i;
  }
  for (const auto& [a, b, c] : mesh.triangles)
  {
    if (std::max({ a, b, c }) >= handles.size() || !result.add_face(handles[a], handles[b], handles[c]).is_valid())
      throw base::Error(base::StatusCode::INVALID_ARGUMENT, "mesh to decimate is no oriented manifold at triangle (" +
                                                                std::to_string(a) + ", " + std::to_string(b) + ", " +
                                                                std::to_string(c) + ")");
  }
  return result;
}
}  // namespace

std::vector<std::string> DecimationOptions::violations() const
{
  base::OptionsCheck check("decimation");
  check.inRange("max_error_m", max_error_m, 1e-6, 0.1);
  return check.violations();
}

DecimationResult decimate(const TriangleMesh& mesh, const DecimationOptions& options)
{
  base::checked(options);
  DecimationResult result;
  result.mesh = mesh;
  if (mesh.triangles.size() <= options.max_triangles)
    return result;
  Mesh empty;
  OpenMesh::VPropHandleT<std::uint32_t> index;
  empty.add_property(index);
  empty.request_face_normals();
  empty.request_vertex_status();
  empty.request_edge_status();
  empty.request_halfedge_status();
  empty.request_face_status();
  Mesh reduced = toOpenMesh(mesh, index, empty);
  reduced.update_face_normals();

  OpenMesh::Decimater::DecimaterT<Mesh> decimater(reduced);
  OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadric;
  OpenMesh::Decimater::ModHausdorffT<Mesh>::Handle hausdorff;
  OpenMesh::Decimater::ModNormalFlippingT<Mesh>::Handle turning;
  decimater.add(quadric);
  decimater.add(hausdorff);
  decimater.add(turning);
  decimater.module(quadric).unset_max_err();
  decimater.module(hausdorff).set_tolerance(static_cast<Mesh::Scalar>(options.max_error_m));
  decimater.module(turning).set_max_normal_deviation(MAX_TURN_DEG);
  decimater.initialize();
  decimater.decimate_to_faces(0, options.max_triangles);
  reduced.garbage_collection();

  result.mesh = {};
  for (const Mesh::VertexHandle handle : reduced.vertices())
  {
    const std::uint32_t i = reduced.property(index, handle);
    result.mesh.vertices.push_back(mesh.vertices[i]);
    if (!mesh.colors.empty())
      result.mesh.colors.push_back(mesh.colors[i]);
    if (!mesh.seen.empty())
      result.mesh.seen.push_back(mesh.seen[i]);
  }
  for (const Mesh::FaceHandle face : reduced.faces())
  {
    std::array<std::uint32_t, 3> triangle{};
    int corner = 0;
    for (const Mesh::VertexHandle handle : reduced.fv_range(face))
      triangle[corner++] = static_cast<std::uint32_t>(handle.idx());
    result.mesh.triangles.push_back(triangle);
  }
  computeNormals(&result.mesh);
  if (options.max_triangles > 0 && result.mesh.triangles.size() > options.max_triangles)
    result.status = { base::StatusCode::NO_RESULT,
                      "mesh keeps " + std::to_string(result.mesh.triangles.size()) + " triangles: fewer, as the " +
                          std::to_string(options.max_triangles) + " asked for, would be off by more than " +
                          std::to_string(1e3 * options.max_error_m) + " mm; allow a larger error or more triangles" };
  return result;
}

}  // namespace object_modelling::mesh
