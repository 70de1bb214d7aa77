#include "../common/run_node.h"
#include "segmenter.h"

int main(int argc, char** argv)
{
  using namespace object_modelling::nodes;
  return runNode<Segmenter>(argc, argv, "segmenter", optionsFrom<SegmenterOptions>);
}
