#include "../common/run_node.h"
#include "modelling_manager.h"

int main(int argc, char** argv)
{
  using namespace object_modelling::nodes;
  return runNode<ModellingManager>(argc, argv, "modelling_manager", optionsFrom<ManagerOptions>);
}
