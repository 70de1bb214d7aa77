#include "object_modelling/registration/pair_figures.h"

namespace object_modelling::registration
{
const std::vector<PairFigure>& pairFigures()
{
  static const std::vector<PairFigure> figures = { { "overlap_ratio", &PairQuality::overlap_ratio },
                                                   { "fsv_ratio", &PairQuality::fsv_ratio },
                                                   { "rmse_m", &PairQuality::rmse_m },
                                                   { "contact_gap_m", &PairQuality::contact_gap_m },
                                                   { "foot_m", &PairQuality::foot_m, false },
                                                   { "turn_rad", &PairQuality::turn_rad, false },
                                                   { "roughness_m", &PairQuality::roughness_m, false },
                                                   { "color_agreement", &PairQuality::color_agreement },
                                                   { "texture", &PairQuality::texture },
                                                   { "light_variance", &PairQuality::light_variance, false },
                                                   { "edge_agreement", &PairQuality::edge_agreement, false },
                                                   { "edge_strength", &PairQuality::edge_strength, false },
                                                   { "features_upheld", &PairQuality::features_upheld, false },
                                                   { "probability", &PairQuality::probability } };
  return figures;
}

}  // namespace object_modelling::registration
