#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <utility>

namespace object_modelling::base
{
/// How an index is made of a random number. The library's distribution is another one in every standard library.
enum class IndexDraw
{
  REMAINDER,
  LIBRARY_DISTRIBUTION
};

/// Seeded samples of SIZE of `count` things.
template <std::size_t SIZE>
class SampleDraws
{
public:
  using Sample = std::array<int, SIZE>;

  SampleDraws(std::size_t count, std::uint64_t seed, IndexDraw draw = IndexDraw::REMAINDER)
      : count_(count), random_(seed), draw_(draw)
  {
  }

  /// Indices below the count; nothing if one is drawn twice, or of fewer than SIZE things.
  std::optional<Sample> next()
  {
    if (count_ < SIZE)
      return std::nullopt;
    Sample sample;
    for (int& index : sample)
      index = drawIndex();
    for (auto i = sample.begin(); i != sample.end(); ++i)
      if (std::find(sample.begin(), i, *i) != i)
        return std::nullopt;
    return sample;
  }

private:
  int drawIndex()
  {
    if (draw_ == IndexDraw::REMAINDER)
      return static_cast<int>(random_() % count_);
    return std::uniform_int_distribution<int>(0, static_cast<int>(count_) - 1)(random_);
  }

  std::size_t count_;
  std::mt19937_64 random_;
  IndexDraw draw_;
};

/// Samples to draw so that with a chance of `confidence_ratio` one of them consists of inliers only. No fewer than for
/// 999 clean samples in 1000, infinite without inliers.
inline double samplesNeeded(double inlier_ratio, std::size_t sample_size, double confidence_ratio)
{
  constexpr double MAX_CLEAN_RATIO = 0.999;
  const double clean_ratio = std::min(MAX_CLEAN_RATIO, std::pow(inlier_ratio, static_cast<double>(sample_size)));
  if (!(clean_ratio > 0))
    return std::numeric_limits<double>::infinity();
  return std::log1p(-confidence_ratio) / std::log1p(-clean_ratio);
}

struct RansacOptions
{
  int max_samples = 1000;          ///< drawn at most
  double confidence_ratio = 0.99;  ///< chance of having drawn one clean sample, at which the drawing stops
  double samples_factor = 1;       ///< of the samples needed: more where not every clean sample gives a good model
  std::uint64_t seed = 1;
  IndexDraw draw = IndexDraw::REMAINDER;
};

template <typename Model>
struct Hypothesis
{
  Model model;
  double inlier_ratio = 0;
};

/// RANSAC: the model of the largest share of inliers, of `start` and those of samples of SIZE of `count` things; of
/// equal ones the first. Nothing if none has inliers.
/// @param solve  std::optional<Model>(sample): the model that a minimal sample defines, nothing of a degenerate one
/// @param inlier_ratio  double(model), in [0, 1]; 0 rejects a model
template <std::size_t SIZE, typename Model, typename Solve, typename InlierRatio>
std::optional<Hypothesis<Model>> ransac(std::size_t count, const RansacOptions& options, Solve solve,
                                        InlierRatio inlier_ratio, std::optional<Hypothesis<Model>> start = std::nullopt)
{
  std::optional<Hypothesis<Model>> best = std::move(start);
  if (count < SIZE)
    return best;
  const auto needed = [&]
  { return options.samples_factor * samplesNeeded(best->inlier_ratio, SIZE, options.confidence_ratio); };
  SampleDraws<SIZE> draws(count, options.seed, options.draw);
  double to_draw = best ? needed() : options.max_samples;
  for (int drawn = 0; drawn < options.max_samples && drawn < to_draw; ++drawn)
  {
    const auto sample = draws.next();
    const std::optional<Model> model = sample ? solve(*sample) : std::nullopt;
    const double ratio = model ? inlier_ratio(*model) : 0;
    if (ratio <= (best ? best->inlier_ratio : 0))
      continue;
    best = Hypothesis<Model>{ *model, ratio };
    to_draw = needed();
  }
  return best;
}

}  // namespace object_modelling::base
