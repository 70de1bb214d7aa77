#include "../common/run_node.h"
#include "model_builder.h"

int main(int argc, char** argv)
{
  using namespace object_modelling::nodes;
  return runNode<ModelBuilder>(argc, argv, "model_builder", optionsFrom<ModelBuilderOptions>);
}
