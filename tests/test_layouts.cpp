#include "device/kernel.hpp"
#include "device/kernel_sources.hpp"
#include "kernel_programs.hpp"

using namespace quadedge;

namespace {

/// One structure of kernels/layouts.cl: its 4-byte values in order, under their C names (a.limits.ncc_min).
struct Structure {
  std::string name;
  std::vector<std::string> values;
};

/// Reads the declarations from the source text, so that no structure and no field can be left out.
std::vector<Structure> declared_structures() {
  std::string text = opencl::embedded_kernels().at("layouts.cl");
  text = std::regex_replace(text, std::regex("//[^\n]*"), "");
  const std::regex structure(R"(\nSTRUCTURE\((\w+)\) \{([^}]*)\};)"), field(R"((\w+)\s+([^;]+);)"),
      item(R"((\w+)(?:\[(\d+)\])?)");
  std::vector<Structure> found;
  for (std::sregex_iterator s(text.begin(), text.end(), structure), end; s != end; ++s) {
    Structure declared{(*s)[1], {}};
    const std::string body = (*s)[2];
    for (std::sregex_iterator f(body.begin(), body.end(), field); f != end; ++f) {
      const std::string type = (*f)[1], names = (*f)[2];
      for (std::sregex_iterator n(names.begin(), names.end(), item); n != end; ++n) {
        const std::string name = (*n)[1];
        if ((*n)[2].matched) {
          for (int k = 0; k < std::stoi((*n)[2]); ++k) declared.values.push_back(name + "[" + std::to_string(k) + "]");
        } else if (type == "int" || type == "float") {
          declared.values.push_back(name);
        } else {
          const auto inner =
              std::find_if(found.begin(), found.end(), [&](const auto& other) { return other.name == type; });
          INFO(declared.name << "." << name << " is a " << type);
          REQUIRE(inner != found.end());
          for (const auto& value : inner->values) declared.values.push_back(name + "." + value);
        }
      }
    }
    found.push_back(std::move(declared));
  }
  return found;
}

/// A kernel that writes every value's bits and the size.
std::string reading_kernel(const Structure& structure) {
  std::string text = "kernel void read_" + structure.name + "(const " + structure.name + " a, global uint* out) {\n";
  for (std::size_t k = 0; k < structure.values.size(); ++k)
    text += "  out[" + std::to_string(k) + "] = as_uint(a." + structure.values[k] + ");\n";
  return text + "  out[" + std::to_string(structure.values.size()) + "] = sizeof(" + structure.name + ");\n}\n";
}

/// Passes a structure whose 4-byte words hold distinct bits; the device must find word k in value k.
template <class T>
void check_structure(opencl::Context& context, const cl::Program& program, const Structure& structure) {
  INFO(structure.name << " on " << context.name());
  const std::size_t words = structure.values.size();
  REQUIRE(sizeof(T) == 4 * words);  // no padding: value k is at byte 4 k
  std::vector<cl_uint> bits(words), expected;
  for (std::size_t k = 0; k < words; ++k) bits[k] = static_cast<cl_uint>(0x3f800000 + 7 * k);  // floats near 1
  T value;
  std::memcpy(&value, bits.data(), sizeof value);
  expected = bits;
  expected.push_back(static_cast<cl_uint>(sizeof(T)));
  opencl::Buffer<cl_uint> out(context, words + 1);
  const opencl::Kernel<void(T, cl_uint*)> kernel(context, program, "read_" + structure.name);
  kernel({1, 1}, value, out);
  CHECK(out.read(words + 1) == expected);
}

template <class... T>
void check_structures(opencl::Context& context, const cl::Program& program, const std::vector<Structure>& structures) {
  REQUIRE(structures.size() == sizeof...(T));
  std::map<std::string, Structure> by_name;
  for (const auto& structure : structures) by_name[structure.name] = structure;
  (check_structure<T>(context, program, by_name.at(opencl::type_name<T>())), ...);
}

}  // namespace

TEST_CASE("layouts: every structure has the host's layout on every device", "[device][oclgrind]") {
  const auto structures = declared_structures();
  std::string source;
  for (const auto& structure : structures) source += reading_kernel(structure);
  for (const auto& index : all_devices()) {
    Device device(index, kept_programs());
    auto& context = *device.context();
    const auto program = build_program(context, {}, source);
    check_structures<PackedPositions, PackedPointIndex, EpipolarGeometry, AlignmentSettings, ThresholdArguments,
                     DetectionArguments, EpipolarRows, SelectionArguments, PatchArguments, SiftArguments,
                     DisparityProbe, StereoCandidateArguments, FilterLimits, FilterArguments, StereoRefinementArguments,
                     StereoClusterArguments, PaperRefinementArguments, PaperClusterArguments, PaperQuadArguments,
                     PaperSimilarityArguments, CoarseDisparityArguments, StereoRelaxationArguments,
                     StereoMutualArguments, PointIndexArguments, TemporalCandidateArguments, QuadChoice,
                     TemporalMatchArguments, TemporalAgreementArguments, TemporalBestArguments, WideSelection,
                     GlobalMatchingArguments>(context, program, structures);
  }
}
