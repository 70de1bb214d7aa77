#pragma once

#include <string>

#include "object_modelling/fusion/cloud_fusion.h"

namespace object_modelling::database
{
/// An object's cloud.pcd: binary_compressed PCD with the fields x y z normal_x normal_y normal_z rgb weight sigma_m, in
/// metres, in the object frame. Throws base::Error: NOT_FOUND, BAD_INPUT (damaged, fields missing).
fusion::FusedCloud readCloud(const std::string& path);
/// Throws base::Error: STORAGE, INVALID_ARGUMENT (empty, vectors of different length).
void writeCloud(const std::string& path, const fusion::FusedCloud& cloud);

}  // namespace object_modelling::database
