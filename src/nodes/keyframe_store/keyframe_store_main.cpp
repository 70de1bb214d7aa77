#include "../common/run_node.h"
#include "keyframe_store.h"

int main(int argc, char** argv)
{
  using namespace object_modelling::nodes;
  return runNode<KeyframeStore>(argc, argv, "keyframe_store", optionsFrom<KeyframeStoreOptions>);
}
