#pragma once
/// `gumshoe trace --append`: evidence over campaigns.
#include <string>

#include <nlohmann/json.hpp>

#include "store/history_file.h"
#include "tracing/trace.h"

namespace gumshoe::cli {

/// A history file, claimed and read before the work.
class History {
public:
  History() = default;
  /// Throws InputError if the file is no history, is of another model or of other equations, or holds these readings
  /// already, or many of them in a row. `path` empty: none is kept.
  History(const std::string& path, const scenario::Scenario& scenario, const ModelCard& card);
  explicit operator bool() const { return !path_.empty(); }

  /// Adds the campaign and drafts the file. A campaign that could not be judged is left out.
  void append(const tracing::Trace& trace, store::Draft& draft);
  /// Some lines: how many to one each effect has for it, whenever one looks.
  std::string text(double alpha) const;
  nlohmann::ordered_json json() const;

private:
  void require_same_model() const;
  std::string path_, id_;
  std::vector<double> rows_; ///< digests of the readings
  std::string model_, model_title_, model_equations_;
  store::Claim claim_;
  std::vector<tracing::Campaign> campaigns_;
  tracing::EvidenceOverTime evidence_;
};

} // namespace gumshoe::cli
