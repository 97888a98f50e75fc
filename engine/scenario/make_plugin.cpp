#include "scenario/made_model.h"
namespace gumshoe::scenario {
models::MadeModel make_plugin(Table& model, const std::string&, Context&) {
  model.add("model: plugins are not there yet");
  return nullptr;
}
} // namespace gumshoe::scenario
