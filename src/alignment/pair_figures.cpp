#include "object_modelling/alignment/pair_figures.h"

namespace object_modelling::alignment
{
const std::vector<PairFigure>& pairFigures()
{
  static const std::vector<PairFigure> figures = {
    { "overlap_ratio", &registration::PairQuality::overlap_ratio },
    { "fsv_ratio", &registration::PairQuality::fsv_ratio },
    { "rmse_m", &registration::PairQuality::rmse_m },
    { "contact_gap_m", &registration::PairQuality::contact_gap_m },
    { "foot_m", &registration::PairQuality::foot_m, false },
    { "turn_rad", &registration::PairQuality::turn_rad, false },
    { "roughness_m", &registration::PairQuality::roughness_m, false },
    { "color_agreement", &registration::PairQuality::color_agreement },
    { "texture", &registration::PairQuality::texture },
    { "light_variance", &registration::PairQuality::light_variance, false },
    { "edge_agreement", &registration::PairQuality::edge_agreement, false },
    { "edge_strength", &registration::PairQuality::edge_strength, false },
    { "features_upheld", &registration::PairQuality::features_upheld, false },
    { "probability", &registration::PairQuality::probability }
  };
  return figures;
}

}  // namespace object_modelling::alignment
