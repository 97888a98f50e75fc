#pragma once
/// Evidence for effects over campaigns of the same machine, valid whenever one looks.
///
/// Each campaign gives an e-value, the ratio of two densities of its residuals: with an effect whose size is believed
/// to be what the campaigns before said of it, and without any. What is believed is fixed before the campaign, both
/// densities leave out what is fitted to it, and its noise's scale is unknown to both (prior d sigma / sigma). Its
/// expectation given the past is 1 where there is no effect, so that the product over campaigns exceeds 1/alpha ever,
/// whenever one stops, with a probability of at most alpha (Ville 1939). The first campaign's belief is wide: as much
/// information as one reading. Averages over variants and effects keep the bound.
/// Sources: Ville, Etude critique de la notion de collectif, 1939; Gruenwald, de Heide, Koolen, J. R. Stat. Soc. B 86
/// (2024) 1091; Perez-Ortiz, Lardy, de Heide, Gruenwald, Annals of Statistics 52 (2024) 1410, for the unknown scale.
#include "tracing/campaigns/campaign.h"

namespace gumshoe::tracing {

/// What the campaigns say of one effect.
struct EffectEvidence {
  std::string candidate;
  double log_evidence = 0; ///< natural logarithm of its e-value, divided by the number of effects looked for
  std::vector<ScoredSize> sizes;
  Vector size, u; ///< of the variant with the most evidence, SI
  int campaigns = 0;
  double log_peak = 0;  ///< the most that `log_evidence` has been; the bound holds for it, too
  int peak = 0;         ///< after so many campaigns
  Vector last, last_u;  ///< by the last campaign that shows it alone, of the same variant
  double agreement = 1; ///< probability that campaigns of one size differ by more (chi-squared); 1: of one campaign
};

struct EvidenceOverTime {
  std::vector<EffectEvidence> effects; ///< those of the first campaign, the most evidence first
  double log_overall = 0;              ///< of the average over all effects: that there is any of them
  int campaigns = 0;
};

/// Campaigns in the order in which they were added. An effect that a campaign does not show keeps its evidence.
EvidenceOverTime evidence_over_time(const std::vector<Campaign>& campaigns);

} // namespace gumshoe::tracing
