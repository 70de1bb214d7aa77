#include "object_modelling/mesh/reference_surface.h"

#include <vtkCellArray.h>
#include <vtkCellLocator.h>
#include <vtkGenericCell.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "object_modelling/base/status.h"
#include "object_modelling/mesh/surface_sampling.h"

namespace object_modelling::mesh
{
namespace
{
constexpr std::size_t SAMPLE_COUNT = 20000;

void check(const TriangleMesh& mesh)
{
  const auto refuse = [](const std::string& reason)
  { throw base::Error(base::StatusCode::BAD_INPUT, "the reference cannot be measured against: " + reason); };
  if (mesh.empty())
    refuse("it has no triangles; a mesh is needed, not a point cloud");
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    if (!vertex.allFinite())
      refuse("a vertex is not finite; repair the mesh");
  if (!(surfaceArea_m2(mesh) > 0))
    refuse("its triangles have no area");
}

}  // namespace

class ReferenceSurface::Locator
{
public:
  explicit Locator(const TriangleMesh& mesh)
  {
    const auto points = vtkSmartPointer<vtkPoints>::New();
    for (const Eigen::Vector3f& vertex : mesh.vertices)
      points->InsertNextPoint(vertex.data());
    const auto cells = vtkSmartPointer<vtkCellArray>::New();
    for (const auto& triangle : mesh.triangles)
    {
      cells->InsertNextCell(3);
      for (const std::uint32_t vertex : triangle)
        cells->InsertCellPoint(vertex);
    }
    const auto polygons = vtkSmartPointer<vtkPolyData>::New();
    polygons->SetPoints(points);
    polygons->SetPolys(cells);
    locator_->SetDataSet(polygons);
    locator_->SetNumberOfCellsPerNode(2);  // twice as fast as the default
    locator_->CacheCellBoundsOn();
    locator_->BuildLocator();
  }

  Eigen::Vector3d closestPoint(const Eigen::Vector3d& p) const
  {
    Eigen::Vector3d query = p;  // VTK before 9 takes no const pointer
    Eigen::Vector3d closest = p;
    vtkIdType cell_id = 0;
    int sub_id = 0;
    double squared_distance = 0;
    locator_->FindClosestPoint(query.data(), closest.data(), cell_, cell_id, sub_id, squared_distance);
    return closest;
  }

private:
  vtkSmartPointer<vtkCellLocator> locator_ = vtkSmartPointer<vtkCellLocator>::New();
  vtkSmartPointer<vtkGenericCell> cell_ = vtkSmartPointer<vtkGenericCell>::New();
};

ReferenceSurface::ReferenceSurface(const TriangleMesh& mesh)
{
  check(mesh);
  locator_ = std::make_unique<Locator>(mesh);
  for (const SurfaceSample& sample : sampleEvenly(mesh, SAMPLE_COUNT))
    samples_.push_back(pointAt(mesh, sample));
  triangle_count_ = mesh.triangles.size();
  Eigen::AlignedBox3d box;
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle)
      box.extend(mesh.vertices[vertex].cast<double>());
  diagonal_m_ = box.diagonal().norm();
}

ReferenceSurface::~ReferenceSurface() = default;

Eigen::Vector3d ReferenceSurface::closestPoint(const Eigen::Vector3d& p_reference) const
{
  return locator_->closestPoint(p_reference);
}

double ReferenceSurface::distance_m(const Eigen::Vector3d& p_reference) const
{
  return (closestPoint(p_reference) - p_reference).norm();
}

}  // namespace object_modelling::mesh
