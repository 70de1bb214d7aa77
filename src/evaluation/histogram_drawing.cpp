#include <algorithm>
#include <cstdio>
#include <string>

#include <opencv2/imgproc.hpp>

#include "object_modelling/evaluation/comparison_files.h"

namespace object_modelling::evaluation
{
namespace
{
constexpr int WIDTH_PX = 960, HEIGHT_PX = 540, LEFT_PX = 80, RIGHT_PX = 30, TOP_PX = 70, BOTTOM_PX = 70;
const cv::Scalar WHITE(255, 255, 255), INK(60, 60, 60), GRID(225, 225, 225), BAR(176, 120, 60), BEYOND(60, 60, 200);

void write(cv::Mat* image, const std::string& text, const cv::Point& at, double size, bool centered)
{
  const cv::Size extent = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size, 1, nullptr);
  cv::putText(*image, text, { at.x - (centered ? extent.width / 2 : 0), at.y }, cv::FONT_HERSHEY_SIMPLEX, size, INK, 1,
              cv::LINE_AA);
}

template <typename... Values>
std::string formatted(const char* format, Values... values)
{
  char text[160];
  std::snprintf(text, sizeof(text), format, values...);
  return text;
}
}  // namespace

cv::Mat drawHistogram(const Histogram& histogram, const DistanceStatistics& statistics)
{
  cv::Mat image(HEIGHT_PX, WIDTH_PX, CV_8UC3, WHITE);
  double total = 0, highest = 0;
  for (const std::size_t count : histogram.counts)
  {
    total += static_cast<double>(count);
    highest = std::max(highest, static_cast<double>(count));
  }
  total = std::max(total, 1.0);  // without distances the bars have no height
  highest = std::max(highest, 1.0);
  const int plot_width_px = WIDTH_PX - LEFT_PX - RIGHT_PX, plot_height_px = HEIGHT_PX - TOP_PX - BOTTOM_PX;
  const int floor_px = HEIGHT_PX - BOTTOM_PX;
  const auto bins = static_cast<int>(histogram.counts.size());
  const auto x_px = [&](int bin) { return LEFT_PX + plot_width_px * bin / bins; };

  constexpr int LINES = 4;
  for (int i = 0; i <= LINES; ++i)
  {
    const int y_px = floor_px - plot_height_px * i / LINES;
    cv::line(image, { LEFT_PX, y_px }, { WIDTH_PX - RIGHT_PX, y_px }, GRID);
    write(&image, formatted("%.1f %%", 100 * highest / total * i / LINES), { LEFT_PX - 70, y_px + 5 }, 0.45, false);
  }
  for (int bin = 0; bin < bins; ++bin)
  {
    const int height_px = cvRound(plot_height_px * static_cast<double>(histogram.counts[bin]) / highest);
    cv::rectangle(image, { x_px(bin) + 1, floor_px - height_px }, { x_px(bin + 1) - 1, floor_px },
                  bin == bins - 1 ? BEYOND : BAR, cv::FILLED);
  }
  constexpr int LABELS = 10;
  for (int i = 0; i <= LABELS; ++i)
  {
    const int bin = bins * i / LABELS;
    write(&image, formatted("%.3g", 1000 * histogram.bin_width_m * bin), { x_px(bin), floor_px + 22 }, 0.45, true);
  }
  write(&image, "distance to the reference (mm); the red bar holds all beyond",
        { LEFT_PX + plot_width_px / 2, floor_px + 50 }, 0.5, true);
  write(&image,
        formatted("mean %.3f mm, sigma %.3f mm, median %.3f mm, 95 %% below %.3f mm, beyond 5 mm %.2f %%",
                  1000 * statistics.mean_m, 1000 * statistics.sigma_m, 1000 * statistics.median_m,
                  1000 * statistics.p95_m, 100 * statistics.outlier_ratio),
        { LEFT_PX, TOP_PX - 30 }, 0.5, false);
  return image;
}

}  // namespace object_modelling::evaluation
