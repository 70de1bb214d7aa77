#include "job_clients.h"

namespace object_modelling::nodes
{
namespace
{
constexpr double CLOCK_POLL_S = 0.1;

ActionLimits limitsOf(const ManagerOptions& options)
{
  return { options.service_wait_s, options.job_silence_s };
}
}  // namespace

JobClients::JobClients(ros::NodeHandle& node, const ManagerOptions& options)
    : refine(node, "refiner/refine", limitsOf(options)),
      segment(node, "segmenter/segment_session", limitsOf(options)),
      align(node, "session_aligner/align", limitsOf(options)),
      build(node, "model_builder/build", limitsOf(options))
{
  // Connecting waits for /clock where time is simulated, and sessions can be recorded before.
  if (ros::Time::isValid())
    connect();
  else
    connect_timer_ = node.createWallTimer(ros::WallDuration(CLOCK_POLL_S),
                                          [this](const ros::WallTimerEvent&)
                                          {
                                            if (!ros::Time::isValid())
                                              return;
                                            connect_timer_.stop();
                                            connect();
                                          });
}

void JobClients::connect()
{
  refine.connect();
  segment.connect();
  align.connect();
  build.connect();
}

}  // namespace object_modelling::nodes
