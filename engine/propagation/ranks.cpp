#include "propagation/ranks.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <thread>

#include <fmt/format.h>
#include <unistd.h>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/module.h"

namespace gumshoe::propagation {

namespace {

/// What launchers set: Open MPI; MPICH, Intel MPI and Slurm's PMI-2; Slurm's PMIx.
constexpr struct {
  const char *rank, *size;
} variables[] = {{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"}, {"PMI_RANK", "PMI_SIZE"}, {"PMIX_RANK", nullptr}};

int number(const char* variable, int otherwise) {
  const char* text = variable ? std::getenv(variable) : nullptr;
  return text ? std::atoi(text) : otherwise;
}

std::unique_ptr<Transport> open_transport(const Launch& launch) {
  std::string why;
  void* const open = module_symbol("gumshoe_mpi", "gumshoe_open_transport", why);
  if (!open)
    throw InputError("this program has no MPI, and a launcher of MPI started several of it", why,
                     "build it where MPI is installed, or use --shard and gumshoe merge");
  std::unique_ptr<Transport> transport(reinterpret_cast<decltype(&gumshoe_open_transport)>(open)());
  if (launch.size > transport->size())
    throw InputError(fmt::format("the launcher started {} processes, which do not find each other", launch.size),
                     "it belongs to another MPI than this program", "use the mpirun of that MPI");
  return transport;
}

// A reply is what was asked for or a failure, and its first letter says which.
constexpr char good_reply = 'g', failure_reply = 'f', part_end = '\0';
constexpr int control_tag = 0, first_thread_tag = 1;

std::string packed(const ResultBlock& block) {
  std::string bytes(1, good_reply);
  bytes.append(reinterpret_cast<const char*>(block.status.data()), block.status.size());
  bytes.append(reinterpret_cast<const char*>(block.outputs.data()), block.outputs.size() * sizeof(double));
  return bytes;
}

ResultBlock unpacked_block(const std::string& bytes, std::uint64_t first, std::uint64_t last) {
  const auto samples = static_cast<std::size_t>(last - first);
  ResultBlock block{first, samples, std::vector<double>((bytes.size() - 1 - samples) / sizeof(double)),
                    std::vector<std::uint8_t>(samples)};
  std::memcpy(block.status.data(), bytes.data() + 1, samples);
  std::memcpy(block.outputs.data(), bytes.data() + 1 + samples, block.outputs.size() * sizeof(double));
  return block;
}

std::string packed(const std::vector<double>& values) {
  std::string bytes(1, good_reply);
  return bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
}

std::vector<double> unpacked_values(const std::string& bytes) {
  std::vector<double> values((bytes.size() - 1) / sizeof(double));
  std::memcpy(values.data(), bytes.data() + 1, values.size() * sizeof(double));
  return values;
}

std::string packed(const std::exception& failure) {
  const auto* input = dynamic_cast<const InputError*>(&failure);
  std::string bytes(1, failure_reply);
  for (const Problem& p : input ? input->problems() : std::vector<Problem>{{{}, failure.what(), "", ""}})
    for (const std::string& part :
         {p.where.file, std::to_string(p.where.line), std::to_string(p.where.column), p.what, p.why, p.remedy})
      bytes += part.c_str() + std::string(1, part_end);
  return bytes;
}

std::vector<Problem> unpacked_problems(const std::string& bytes) {
  std::vector<std::string> parts;
  for (std::size_t at = 1; at < bytes.size(); at += parts.back().size() + 1) parts.emplace_back(bytes.c_str() + at);
  std::vector<Problem> problems;
  for (std::size_t k = 0; k + 5 < parts.size(); k += 6)
    problems.push_back(
        {{parts[k], std::stoi(parts[k + 1]), std::stoi(parts[k + 2])}, parts[k + 3], parts[k + 4], parts[k + 5]});
  return problems;
}

} // namespace

std::optional<Launch> launched() {
  for (const auto& v : variables) { // Open MPI sets PMIX_RANK, too: the first that is set decides
    const Launch launch{number(v.rank, -1), number(v.size, 0)};
    if (launch.rank >= 0) return launch.size == 1 ? std::nullopt : std::optional(launch);
  }
  return std::nullopt;
}

std::unique_ptr<Ranks> Ranks::join() {
  const std::optional<Launch> launch = launched();
  if (!launch) return nullptr;
  std::unique_ptr<Ranks> ranks(new Ranks(open_transport(*launch)));
  for (const auto& v : variables) unsetenv(v.rank);
  if (!ranks
           ->first()) // rank 0 says when to stop; a handler, because programs that a model starts would inherit SIG_IGN
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, [](int) {});
  return ranks;
}

Ranks::~Ranks() {
  if (interrupted()) {
    transport_.release();
    return;
  }
  if (!first()) return;
  for (int rank = 1; rank < transport_->size() && !begun_; ++rank) transport_->send(rank, control_tag, "");
  for (const Place& place : places_) transport_->send(place.rank, place.tag, "");
}

/// Waits by polling: with pauses that are short beside the time waited so far.
std::string Ranks::receive(int from, int tag) {
  using namespace std::chrono;
  const auto begun = steady_clock::now();
  for (;;) {
    if (auto message = transport_->poll(from, tag)) return std::move(*message);
    stop_if_interrupted();
    const auto waited = duration_cast<microseconds>(steady_clock::now() - begun);
    std::this_thread::sleep_for(std::clamp(waited / 20, microseconds(20), microseconds(1000)));
  }
}

Help Ranks::begin(const std::string& run) {
  begun_ = true;
  for (int rank = 1; rank < transport_->size(); ++rank) transport_->send(rank, control_tag, run);
  std::vector<Problem> problems;
  Help help;
  for (int rank = 1; rank < transport_->size(); ++rank) {
    const std::string reply = receive(rank, control_tag);
    if (reply[0] == failure_reply) {
      std::ranges::move(unpacked_problems(reply), std::back_inserter(problems));
      continue;
    }
    const int threads = std::stoi(reply.substr(1));
    for (int tag = first_thread_tag; tag < first_thread_tag + threads; ++tag) {
      const Place place = places_.emplace_back(Place{rank, tag});
      help.blocks.push_back([this, place](std::uint64_t first, std::uint64_t last) {
        return unpacked_block(ask(place, first, last, ""), first, last);
      });
      help.units.push_back([this, place](const Work& work, std::uint64_t first, std::uint64_t last) {
        return unpacked_values(ask(place, first, last, work.name));
      });
    }
  }
  if (!problems.empty()) throw InputError(problems);
  return help;
}

std::string Ranks::ask(const Place& place, std::uint64_t first, std::uint64_t last, const std::string& work) {
  transport_->send(place.rank, place.tag, fmt::format("{} {} {}", first, last, work));
  std::string reply = receive(place.rank, place.tag);
  if (reply[0] == failure_reply) throw InputError(unpacked_problems(reply));
  return reply;
}

std::optional<std::string> Ranks::awaited() {
  std::string run = receive(0, control_tag);
  if (run.empty()) return std::nullopt;
  return run;
}

void Ranks::serve(const Service& service, int threads) {
  std::vector<std::jthread> workers;
  try {
    for (int t = 0; t < threads; ++t) workers.emplace_back([&, t] { answer(service, first_thread_tag + t); });
  } catch (const std::system_error&) { // no further thread can be started: rank 0 hears of those that there are
    if (workers.empty()) throw;
  }
  transport_->send(0, control_tag, good_reply + std::to_string(workers.size()));
}

void Ranks::answer(const Service& service, int tag) {
  for (std::string wanted; !(wanted = receive(0, tag)).empty();) {
    std::string reply;
    try {
      char* rest = nullptr;
      const std::uint64_t first = std::strtoull(wanted.c_str(), &rest, 10), last = std::strtoull(rest, &rest, 10);
      if (const std::string name = rest + 1; !name.empty()) {
        const Work work = service.work(name);
        std::vector<double> values((last - first) * work.values);
        work.compute(first, last, values.data());
        reply = packed(values);
      } else {
        reply = packed(service.block(first, last));
      }
    } catch (const std::exception& failure) {
      reply = packed(failure);
    }
    transport_->send(0, tag, reply);
  }
}

void Ranks::report(const std::exception& failure) { transport_->send(0, control_tag, packed(failure)); }

} // namespace gumshoe::propagation
