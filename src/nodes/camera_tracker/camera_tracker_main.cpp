#include "../common/run_node.h"
#include "camera_tracker_node.h"

int main(int argc, char** argv)
{
  using namespace object_modelling::nodes;
  return runNode<CameraTrackerNode>(argc, argv, "camera_tracker", optionsFrom<CameraTrackerNodeOptions>);
}
