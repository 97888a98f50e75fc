#pragma once
/// A model of the single socket method on a machine that a scenario describes.
#include <string>

#include "chain/machine.h"
#include "models/model.h"

namespace gumshoe::models::turned_ball {

/// Measurands of a card that stand for the error of the first and of the second rotary axis; empty: none.
struct ErrorsOfAxes {
  std::string_view first = {}, second = {};
};

/// Model::on_machine of both models: the row `model` with the machine's axes as context (axes_of) and as axes of its
/// card. Measurands `named` take the names d_alpha, d_beta, d_gamma by the directions of the axes.
MadeModel on_machine(const Model& model, const chain::MachineDescription& machine, const ErrorsOfAxes& named,
                     std::string& why);

} // namespace gumshoe::models::turned_ball
