#pragma once
/// A model whose rotary axes have the location errors of location_rows.h, on a machine that a scenario describes.
#include <string>

#include "chain/machine.h"
#include "models/model.h"

namespace gumshoe::models {

/// Model::on_machine: the row `model` with the two rotary axes as context (axes_of) and the card's rows and conditions
/// by their names. The machine has one slide along each of X, Y and Z on the bed and two rotary axes behind them, about
/// two directions, each on the side of the table or of the head.
MadeModel on_located_axes(const Model& model, const chain::MachineDescription& machine, std::string& why);

} // namespace gumshoe::models
