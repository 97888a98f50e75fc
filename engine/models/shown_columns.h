#pragma once
/// Blocks in the units of the model's card: users' models (plugins, commands) see "mm" where the engine has m.
#include <deque>
#include <string>
#include <vector>

#include "models/model.h"

namespace gumshoe::models {

/// Columns of one reading in card order. Where nothing is to convert they are the block's own.
struct ShownReading {
  std::vector<Column> quantities, conditions, indications;
  std::deque<std::vector<double>> converted; ///< what the columns point to otherwise
};

/// `indications`: false before a simulation, when there are none yet.
ShownReading shown_reading(const ModelCard& card, const BlockCall& call, std::size_t reading, bool indications);

/// Turns n values from the card's unit to SI, in place; marks what is not finite as failed.
void take_shown(const VariableCard& variable, double* values, std::size_t n, std::uint8_t* status);

/// Asks for one point, and for it twice in another call. Empty if the answers agree to 1e-12; else how they
/// differ: "y is 1.2 mm, then 1.3 mm". Then the model draws random numbers of its own, or its points depend on one
/// another.
std::string differing_answers(const ModelCard& card, const PointCall<double>& point, void (*kernel)(const BlockCall&));

/// The measurands by name, for `explain`; NaN where the sample failed.
std::vector<Intermediate> explained(const ModelCard& card, const PointCall<double>& point,
                                    void (*kernel)(const BlockCall&));

/// "samples 2048 to 4095", "point 3" ...: which samples of the run a message is about.
std::string span_text(std::uint64_t first_sample, std::size_t offset, std::size_t n);

} // namespace gumshoe::models
