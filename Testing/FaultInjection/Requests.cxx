#include "Requests.h"

#include <fstream>
#include <stdexcept>

#include <unistd.h>

namespace fenestra::core::faults {
namespace {

namespace fs = std::filesystem;

using Arguments = std::vector<std::string>;

Arguments concat(Arguments first, const Arguments& more) {
  first.insert(first.end(), more.begin(), more.end());
  return first;
}

std::vector<Request> makeRequests() {
  const Arguments quick = {"--size", "16x16", "--samples", "1", "--threads", "1", "--quiet"};
  const Arguments render =
      concat({"render", "knee.mrb", "--focus", "FemoralCartilage", "--output", "o.exr", "--output",
              "o.png", "--surface", "o.vtp", "--stats-json", "s.json"},
             quick);
  const Arguments turntable = concat({"turntable", "knee.mrb", "--frames", "2", "--output", "t.png",
                                      "--stats-json", "s.json", "--restart"},
                                     quick);
  const Arguments batch = concat({"batch", "t.csv", "--output", "d"}, quick);
  const Arguments phantom = {"phantom", "cube", "--output", "p", "--size", "16", "--quiet"};
  const auto renderCheckpointed = [](const char* samples) {
    return Arguments{"render", "knee.mrb",  "--size", "16x16",   "--samples",
                     samples,  "--threads", "1",      "--quiet", "--checkpoint",
                     "o.film", "--output",  "o.exr"};
  };
  const auto renderShard = [](const char* shard, const char* checkpoint) {
    return Arguments{"render", "knee.mrb", "--shard", shard, "--checkpoint", checkpoint};
  };
  // Name, arguments, commands before, groups, stats, manifest, checkpoint, left checkpoint, inputs.
  Request phantomRequest = {"phantom", phantom, {concat(phantom, {"--edge", "2"})}, {{}}, "", ""};
  for (const char* ending :
       {".mrml", ".mrb", ".nrrd", ".seg.nrrd", ".vp", ".vp.json", "-roi.mrk.json"})
    phantomRequest.groups[0].push_back("p/cube" + std::string(ending));
  return {
      {"render",
       render,
       {concat(render, {"--seed", "7", "--clip-offset", "2"})},
       {{"o.exr", "o.png", "o.vtp"}},
       "s.json",
       ""},
      {"turntable",
       turntable,
       {concat(turntable, {"--seed", "7"})},
       {{"t_0000.png"}, {"t_0001.png"}},
       "s.json",
       "t.turntable.json"},
      phantomRequest,
      {"batch",
       batch,
       {concat(batch, {"--seed", "7"})},
       {{"d/a/a.png"}},
       "d/a/a.json",
       "d/a/a.study.json",
       "",
       "d/a/a.film",
       {{"t.csv", "name,input\na,knee.mrb\n"}}},
      {"checkpoint",
       renderCheckpointed("2"),
       {renderCheckpointed("1")},
       {{"o.exr"}},
       "",
       "",
       "o.film"},
      {"merge",
       {"merge", "a.film", "b.film", "--output", "o.exr", "--threads", "1", "--quiet"},
       {concat(renderShard("1/2", "a.film"), quick), concat(renderShard("2/2", "b.film"), quick),
        concat({"render", "knee.mrb", "--seed", "7", "--output", "o.exr"}, quick)},
       {{"o.exr"}},
       "",
       ""},
  };
}

} // namespace

const std::vector<Request>& requests() {
  static const std::vector<Request> allRequests = makeRequests();
  return allRequests;
}

std::string readBytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Files Workspace::listFiles(const fs::path& folder) {
  Files files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string();
    if (entry.is_directory())
      files[name + "/"];
    else
      files[name] = readBytes(entry.path());
  }
  return files;
}

Workspace::Workspace(const Tools& tools) : m_tools(tools) {
  const fs::path sharedMemory = "/dev/shm";
  std::string name =
      ((::access(sharedMemory.c_str(), W_OK) == 0 ? sharedMemory : fs::temp_directory_path()) /
       "faults-XXXXXX")
          .string();
  if (!::mkdtemp(name.data()))
    throw std::runtime_error("cannot create a folder for runs");
  m_root = name;
}

Workspace::~Workspace() {
  std::error_code ignored;
  fs::remove_all(m_root, ignored);
}

void Workspace::fill(const Files& files) const {
  for (const fs::path& path : {folder(), temporary()}) {
    fs::remove_all(path);
    fs::create_directory(path);
  }
  for (const auto& [name, content] : files)
    if (name.ends_with('/'))
      fs::create_directories(folder() / name);
    else
      std::ofstream(folder() / name, std::ios::binary) << content;
}

Outcome Workspace::run(const Arguments& words, const Fault& fault) const {
  return faults::run(
      {concat({m_tools.executable.string()}, words), folder(), temporary(), m_tools.preload},
      fault);
}

Baseline recordBaseline(const Request& request, const Tools& tools) {
  const Workspace workspace(tools);
  Files inputs = request.inputs;
  inputs.emplace("knee.mrb", readBytes(tools.data / "knee/knee.mrb"));
  // The checkpoint files are inputs of merge; other requests have none.
  Baseline baseline = {&request, {}, {}, {"a.film", "b.film"}, {}};
  for (const auto& [name, content] : inputs)
    baseline.inputs.push_back(name);
  workspace.fill(inputs);
  std::vector<Outcome> outcomes;
  for (const Arguments& words : request.before)
    outcomes.push_back(workspace.run(words, {}));
  baseline.before = workspace.files();
  baseline.outcome = workspace.run(request.arguments, {Fault::Kind::counting});
  baseline.after = workspace.files();
  outcomes.push_back(baseline.outcome);
  for (const Outcome& outcome : outcomes)
    if (outcome.status != 0)
      throw std::runtime_error(request.name + " fails without a fault: " + outcome.errors);
  if (baseline.outcome.calls == 0 || baseline.outcome.allocations == 0)
    throw std::runtime_error("the start of main was not traced");
  return baseline;
}

} // namespace fenestra::core::faults
