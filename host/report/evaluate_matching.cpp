#include "quadedge/evaluate_matching.hpp"

#include "evaluation/matching_observer.hpp"
#include "report/matching_json.hpp"

namespace quadedge {
namespace {

std::string evaluate(const evaluation::MatchingSource& source, Device& device, const Config& config, int frames) {
  evaluation::MatchingOptions options;
  options.frames = frames;
  options.distributions = true;
  report::MatchingFacts facts;
  facts.inputs = {source.name()};
  facts.device = device.info();
  facts.config = config;
  return report::matching_json({evaluation::evaluate_matching(source, device, config, options)}, facts);
}

}  // namespace

std::string evaluate_matching(const Dataset& dataset, Device& device, const Config& config, int frames) {
  return evaluate(*evaluation::make_recorded_source(dataset), device, config, frames);
}

std::string evaluate_matching(const SyntheticOptions& scene, Device& device, const Config& config, int frames) {
  return evaluate(*evaluation::make_rendered_source(scene), device, config, frames);
}

}  // namespace quadedge
