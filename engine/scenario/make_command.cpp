#include "scenario/made_model.h"
namespace gumshoe::scenario {
models::MadeModel make_command(Table& model, Table&, const std::string&, Context&) {
  model.add("model: commands are not there yet");
  return nullptr;
}
} // namespace gumshoe::scenario
