#include "../common/run_node.h"
#include "recogniser_node.h"

int main(int argc, char** argv)
{
  using namespace object_modelling::nodes;
  return runNode<RecogniserNode>(argc, argv, "recogniser", optionsFrom<RecogniserNodeOptions>);
}
