#include "scenario/made_model.h"
namespace gumshoe::scenario {
models::MadeModel make_expression(Table& model, Table&, Context&) {
  model.add("model: expressions are not there yet");
  return nullptr;
}
} // namespace gumshoe::scenario
