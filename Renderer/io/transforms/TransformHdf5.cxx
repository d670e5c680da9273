// The HDF5 kind of ITK's transform files: /TransformGroup/<n> holds TransformType,
// TransformParameters and TransformFixedParameters.

#include "io/transforms/Hdf5File.h"
#include "io/transforms/TransformRecords.h"

namespace fenestra {
namespace {

using Links = Hdf5File::Links;

Hdf5File::Address follow(const Links& links, const std::string& name) {
  const auto found = links.find(name);
  if (found == links.end())
    throw Hdf5Error("a name is missing");
  return found->second;
}

/// ITK wrote the names without their first s until 5.0 and reads either.
std::vector<double> numbers(const Hdf5File& file, const Links& group, const std::string& name) {
  const bool now = group.contains("Transform" + name);
  return file.numbers(follow(group, (now ? "Transform" : "Tranform") + name), mostParameters);
}

TransformRecord readRecord(const std::filesystem::path& path, const Hdf5File& file,
                           const Links& group) {
  constexpr std::size_t longestName = 256;
  TransformRecord record =
      transformRecord(path, file.text(follow(group, "TransformType"), longestName));
  if (record.type != "CompositeTransform") { // whose parts follow it
    record.parameters = numbers(file, group, "Parameters");
    record.fixed = numbers(file, group, "FixedParameters");
  }
  return record;
}

} // namespace

std::vector<TransformRecord> readTransformHdf5(const std::filesystem::path& path) {
  try {
    const Hdf5File file(path);
    const Links groups = file.links(follow(file.links(file.root()), "TransformGroup"));
    if (groups.size() > mostRecords)
      throw Hdf5Error("there are too many");
    std::vector<TransformRecord> records;
    for (std::size_t i = 0; i < groups.size(); ++i)
      records.push_back(readRecord(path, file, file.links(follow(groups, std::to_string(i)))));
    return records;
  } catch (const Hdf5Error&) {
    throwDamagedTransform(path);
  }
}

} // namespace fenestra
