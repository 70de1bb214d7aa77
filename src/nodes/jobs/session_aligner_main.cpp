#include "../common/run_node.h"
#include "session_aligner.h"

int main(int argc, char** argv)
{
  using namespace object_modelling::nodes;
  return runNode<SessionAligner>(argc, argv, "session_aligner", optionsFrom<SessionAlignerOptions>);
}
