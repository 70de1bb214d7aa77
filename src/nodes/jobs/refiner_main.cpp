#include "../common/run_node.h"
#include "refiner.h"

int main(int argc, char** argv)
{
  using namespace object_modelling::nodes;
  return runNode<Refiner>(argc, argv, "refiner", optionsFrom<RefinerOptions>);
}
