#include "phantoms/PhantomScene.h"
#include "phantoms/PhantomWriter.h"
#include "phantoms/Phantoms.h"

#include "Approx.h"
#include "TemporaryFolder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <zip.h>

#include <ctime>
#include <map>
#include <set>

namespace fenestra::core::PhantomSceneTests {
namespace {

std::vector<double> readNumbers(const pugi::xml_node& node, const char* attribute) {
  std::istringstream text(node.attribute(attribute).value());
  std::vector<double> values;
  for (double x; text >> x;)
    values.push_back(x);
  EXPECT_TRUE(text.eof()) << attribute;
  return values;
}

Vec3 readVec3(const pugi::xml_node& node, const char* attribute) {
  const std::vector<double> values = readNumbers(node, attribute);
  EXPECT_EQ(values.size(), 3u) << attribute;
  return values.size() == 3 ? Vec3(values[0], values[1], values[2]) : Vec3(Vec3::Zero());
}

/// The voxel axes of the knee differ from the world axes, so that swapped axes are detected.
struct PhantomSceneFiles : ::testing::Test {
  TemporaryFolder folder;
  Phantom phantom = makeKneePhantom({32, 36, 16});
  std::vector<std::string> files = writePhantom(phantom, folder.path(), "knee");
  pugi::xml_document document;
  pugi::xml_node scene;

  void SetUp() override {
    ASSERT_TRUE(document.load_file((folder / "knee.mrml").c_str()));
    scene = document.child("MRML");
  }

  pugi::xml_node node(const char* tag) const {
    const pugi::xml_node found = scene.child(tag);
    EXPECT_TRUE(found) << tag;
    EXPECT_FALSE(found.next_sibling(tag)) << "a second " << tag;
    return found;
  }

  static std::string text(const pugi::xml_node& node, const char* attribute) {
    EXPECT_TRUE(node.attribute(attribute)) << node.name() << " lacks " << attribute;
    return node.attribute(attribute).value();
  }

  void expectAttributes(const char* tag,
                        const std::vector<std::pair<const char*, const char*>>& attributes) const {
    for (const auto& [name, value] : attributes)
      EXPECT_EQ(text(node(tag), name), value) << tag << ' ' << name;
  }

  /// Ids in a node's `references` for one role.
  static std::vector<std::string> readReferences(const pugi::xml_node& node,
                                                 const std::string& role) {
    std::istringstream roles(node.attribute("references").value());
    for (std::string entry; std::getline(roles, entry, ';');)
      if (entry.starts_with(role + ":")) {
        std::istringstream ids(entry.substr(role.size() + 1));
        return {std::istream_iterator<std::string>(ids), {}};
      }
    return {};
  }
};

TEST_F(PhantomSceneFiles, RootHasSlicerVersion) {
  EXPECT_TRUE(readBytes(folder / "knee.mrml")
                  .starts_with("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<MRML "));
  EXPECT_EQ(text(scene, "version"), "Slicer 5.2.2 31383");
  EXPECT_EQ(text(scene, "userTags"), "");
}

TEST_F(PhantomSceneFiles, EveryNodeHasClassInIdAndOccursOnce) {
  const std::map<std::string, std::string> classes = {
      {"View", "vtkMRMLViewNode"},
      {"Camera", "vtkMRMLCameraNode"},
      {"Volume", "vtkMRMLScalarVolumeNode"},
      {"VolumeDisplay", "vtkMRMLScalarVolumeDisplayNode"},
      {"VolumeArchetypeStorage", "vtkMRMLVolumeArchetypeStorageNode"},
      {"Segmentation", "vtkMRMLSegmentationNode"},
      {"SegmentationDisplay", "vtkMRMLSegmentationDisplayNode"},
      {"SegmentationStorage", "vtkMRMLSegmentationStorageNode"},
      {"GPURayCastVolumeRendering", "vtkMRMLGPURayCastVolumeRenderingDisplayNode"},
      {"VolumeProperty", "vtkMRMLVolumePropertyNode"},
      {"VolumePropertyStorage", "vtkMRMLVolumePropertyStorageNode"},
      {"MarkupsROI", "vtkMRMLMarkupsROINode"},
      {"MarkupsROIDisplay", "vtkMRMLMarkupsROIDisplayNode"},
      {"MarkupsROIJsonStorage", "vtkMRMLMarkupsROIJsonStorageNode"}};
  std::set<std::string> tags;
  for (const pugi::xml_node& child : scene.children()) {
    EXPECT_TRUE(tags.insert(child.name()).second) << child.name();
    ASSERT_TRUE(classes.contains(child.name())) << child.name();
    EXPECT_EQ(text(child, "id"), classes.at(child.name()) + "1");
    EXPECT_NE(text(child, "name"), "");
    for (const char* flag : {"hideFromEditors", "selectable", "selected"})
      EXPECT_TRUE(text(child, flag) == "true" || text(child, flag) == "false") << flag;
    std::set<std::string> attributes;
    for (const pugi::xml_attribute& attribute : child.attributes())
      EXPECT_TRUE(attributes.insert(attribute.name()).second)
          << child.name() << ' ' << attribute.name();
  }
  EXPECT_EQ(tags.size(), classes.size());
}

TEST_F(PhantomSceneFiles, EveryReferenceResolvesToNode) {
  const std::map<std::string, std::map<std::string, std::vector<std::string>>> expected = {
      {"Volume",
       {{"display", {"VolumeDisplay", "GPURayCastVolumeRendering"}},
        {"storage", {"VolumeArchetypeStorage"}}}},
      {"Segmentation",
       {{"display", {"SegmentationDisplay"}}, {"storage", {"SegmentationStorage"}}}},
      {"GPURayCastVolumeRendering",
       {{"volumeProperty", {"VolumeProperty"}}, {"roi", {"MarkupsROI"}}}},
      {"VolumeProperty", {{"storage", {"VolumePropertyStorage"}}}},
      {"MarkupsROI", {{"display", {"MarkupsROIDisplay"}}, {"storage", {"MarkupsROIJsonStorage"}}}}};
  std::size_t found = 0;
  for (const auto& [tag, roles] : expected)
    for (const auto& [role, targets] : roles) {
      std::vector<std::string> ids;
      for (const std::string& target : targets)
        ids.push_back(text(node(target.c_str()), "id"));
      EXPECT_EQ(readReferences(node(tag.c_str()), role), ids) << tag << ' ' << role;
      ++found;
    }
  std::size_t written = 0;
  for (const pugi::xml_node& child : scene.children()) {
    const std::string references = child.attribute("references").value();
    EXPECT_TRUE(references.empty() || references.ends_with(";"));
    written += static_cast<std::size_t>(std::count(references.begin(), references.end(), ';'));
  }
  EXPECT_EQ(written, found);
  EXPECT_EQ(text(node("GPURayCastVolumeRendering"), "viewNodeRef"), text(node("View"), "id"));
}

TEST_F(PhantomSceneFiles, StorageNodesNameExistingFiles) {
  const std::map<std::string, std::pair<std::string, std::string>> expected = {
      {"VolumeArchetypeStorage", {"knee.nrrd", "nrrd"}},
      {"SegmentationStorage", {"knee.seg.nrrd", "seg.nrrd"}},
      {"VolumePropertyStorage", {"knee.vp", "vp"}},
      {"MarkupsROIJsonStorage", {"knee-roi.mrk.json", "mrk.json"}}};
  for (const auto& [tag, file] : expected) {
    EXPECT_EQ(text(node(tag.c_str()), "fileName"), file.first);
    EXPECT_EQ(text(node(tag.c_str()), "defaultWriteFileExtension"), file.second);
    EXPECT_TRUE(std::filesystem::exists(folder / file.first));
    expectAttributes(tag.c_str(),
                     {{"useCompression", "1"}, {"readState", "0"}, {"writeState", "4"}});
  }
  expectAttributes("VolumeArchetypeStorage",
                   {{"centerImage", "0"}, {"UseOrientationFromFile", "1"}});
  expectAttributes("SegmentationStorage", {{"CropToMinimumExtent", "false"}});
  expectAttributes("MarkupsROIJsonStorage", {{"coordinateSystem", "LPS"}});
}

TEST_F(PhantomSceneFiles, VolumeNodeHasGridInRas) {
  const pugi::xml_node volume = node("Volume");
  const Grid& grid = phantom.volume.grid;
  EXPECT_TRUE(isApprox(readVec3(volume, "spacing"), grid.spacing(), 1e-5));
  EXPECT_TRUE(isApprox(readVec3(volume, "origin"), grid.indexToWorld.translation(), 1e-5));
  const std::vector<double> directions = readNumbers(volume, "ijkToRASDirections");
  EXPECT_EQ(directions, (std::vector<double>{0, 0, 1, -1, 0, 0, 0, -1, 0})) << "P, I, R in columns";
  EXPECT_EQ(text(volume, "ijkToRASDirections").find('-'),
            text(volume, "ijkToRASDirections").find("-1"));
  expectAttributes("Volume", {{"voxelVectorType", "undefined"}, {"name", "knee"}});
  expectAttributes("VolumeDisplay",
                   {{"colorNodeID", "vtkMRMLColorTableNodeGrey"}, {"applyThreshold", "0"}});
  EXPECT_EQ(readNumbers(node("VolumeDisplay"), "window").at(0),
            phantom.volume.maximum - phantom.volume.minimum);
}

TEST_F(PhantomSceneFiles, SegmentationIsLabelmapForOldAndNewSlicer) {
  expectAttributes("Segmentation", {{"MasterRepresentationName", "Binary labelmap"},
                                    {"SourceRepresentationName", "Binary labelmap"},
                                    {"segmentListFilterEnabled", "false"}});
  expectAttributes("SegmentationDisplay", {{"Visibility2DFill", "true"}, {"Opacity2DFill", "0.5"}});
  std::istringstream properties(text(node("SegmentationDisplay"), "SegmentationDisplayProperties"));
  std::size_t count = 0;
  for (std::string entry; std::getline(properties, entry, '|'); ++count) {
    ASSERT_LT(count, phantom.segments.size());
    EXPECT_TRUE(entry.starts_with(phantom.segments[count].id + " OverrideColorR:-1 "));
    EXPECT_NE(entry.find(" Visible:true Visible3D:true "), std::string::npos);
  }
  EXPECT_EQ(count, phantom.segments.size());
}

TEST_F(PhantomSceneFiles, RenderingIsNotCropped) {
  expectAttributes("GPURayCastVolumeRendering", {{"croppingEnabled", "0"},
                                                 {"visibility", "true"},
                                                 {"followVolumeDisplayNode", "0"},
                                                 {"ignoreVolumeDisplayNodeThreshold", "0"},
                                                 {"useSingleVolumeProperty", "0"}});
}

TEST_F(PhantomSceneFiles, PropertyIsEqualInSceneAndFile) {
  const pugi::xml_node property = node("VolumeProperty");
  std::istringstream file(readBytes(folder / "knee.vp"));
  for (const char* attribute :
       {"interpolation", "shade", "diffuse", "ambient", "specular", "specularPower",
        "scalarOpacity", "gradientOpacity", "colorTransfer"}) {
    std::string line;
    ASSERT_TRUE(std::getline(file, line));
    EXPECT_EQ(text(property, attribute), line) << attribute;
  }
  EXPECT_EQ(file.peek(), EOF);
  const std::vector<double> opacity = readNumbers(property, "scalarOpacity");
  ASSERT_EQ(opacity.size(), 2 * phantom.property.scalarOpacity.size() + 1);
  EXPECT_EQ(opacity[0], static_cast<double>(opacity.size() - 1));
  for (std::size_t i = 0; i < phantom.property.scalarOpacity.size(); ++i) {
    EXPECT_EQ(opacity[2 * i + 1], phantom.property.scalarOpacity[i].x);
    EXPECT_EQ(opacity[2 * i + 2], phantom.property.scalarOpacity[i].value);
  }
  EXPECT_EQ(readNumbers(property, "colorTransfer").size(), 4 * phantom.property.color.size() + 1);
  EXPECT_EQ(readNumbers(property, "effectiveRange"),
            (std::vector<double>{phantom.volume.minimum, phantom.volume.maximum}));
  EXPECT_EQ(text(property, "shade"), "1");
}

TEST_F(PhantomSceneFiles, CameraBelongsToViewAndFitsVolume) {
  const pugi::xml_node camera = node("Camera"), view = node("View");
  EXPECT_EQ(text(camera, "singletonTag"), text(view, "layoutName"));
  EXPECT_EQ(text(view, "singletonTag"), text(view, "layoutName"));
  expectAttributes("View", {{"layoutName", "1"},
                            {"attributes", "MappedInLayout:1"},
                            {"raycastTechnique", "Composite"},
                            {"renderMode", "Orthographic"}});
  expectAttributes("Camera", {{"parallelProjection", "true"},
                              {"viewAngle", "30"},
                              {"appliedTransform", "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1"}});
  const Vec3 position = readVec3(camera, "position"), target = readVec3(camera, "focalPoint");
  const Vec3 up = readVec3(camera, "viewUp");
  const Grid& grid = phantom.volume.grid;
  EXPECT_TRUE(isApprox(target, grid.worldCenter(), 1e-5));
  const Vec3 backward = (position - target).normalized();
  EXPECT_GT(backward.y(), 0.7) << "the camera must be anterior";
  EXPECT_TRUE(isApprox(backward, phantom.towardViewer.normalized(), 1e-4));
  EXPECT_NEAR(up.dot(backward), 0.0, 1e-5);
  EXPECT_NEAR(up.norm(), 1.0, 1e-5);
  EXPECT_GT(up.z(), 0.8);
  const double scale = readNumbers(camera, "parallelScale").at(0);
  EXPECT_EQ(readNumbers(view, "fieldOfView").at(0), scale); // Slicer sets the camera to this value
  double extent = 0.0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 offset = grid.worldCorner(i) - target;
    extent = std::max({extent, std::abs(offset.dot(up)), std::abs(offset.dot(up.cross(backward)))});
    EXPECT_LT(offset.dot(backward), (position - target).norm()) << "a corner is behind the camera";
  }
  EXPECT_NEAR(extent / scale, 1.0 / 1.05, 1e-4) << "half the viewport's height";
}

TEST_F(PhantomSceneFiles, RegionOfInterestIsVolumeBoxInLps) {
  const auto json = nlohmann::json::parse(readBytes(folder / "knee-roi.mrk.json"));
  EXPECT_NE(json.at("@schema").get<std::string>().find("markups-schema-v1.0.3.json#"),
            std::string::npos);
  const auto& roi = json.at("markups").at(0);
  EXPECT_EQ(roi.at("type"), "ROI");
  EXPECT_EQ(roi.at("roiType"), "Box");
  EXPECT_EQ(roi.at("coordinateSystem"), "LPS");
  EXPECT_EQ(roi.at("insideOut"), false);
  const auto vector = [&](const char* key) { return roi.at(key).get<std::vector<double>>(); };
  const Vec3 flip(-1, -1, 1);
  const std::vector<double> center = vector("center"), size = vector("size"),
                            o = vector("orientation");
  ASSERT_EQ(o.size(), 9u);
  const Grid& grid = phantom.volume.grid;
  Affine boxToWorld = Affine::Identity(); // maps [-1/2, 1/2]^3
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      boxToWorld.linear()(row, column) = flip[row] * o[static_cast<std::size_t>(3 * row + column)] *
                                         size[static_cast<std::size_t>(column)];
  boxToWorld.translation() = flip.cwiseProduct(Vec3(center[0], center[1], center[2]));
  const Box unit{Vec3::Constant(-0.5), Vec3::Constant(0.5)};
  for (int i = 0; i < 8; ++i)
    EXPECT_LT((boxToWorld * unit.corner(i) - grid.worldCorner(i)).norm(), 1e-9) << i;
}

struct ZipFile {
  explicit ZipFile(const std::filesystem::path& path)
      : archive(zip_open(path.c_str(), ZIP_RDONLY, nullptr)) {}
  ~ZipFile() { zip_discard(archive); }
  ZipFile(const ZipFile&) = delete;
  ZipFile& operator=(const ZipFile&) = delete;

  std::vector<std::string> names() const {
    std::vector<std::string> result;
    for (zip_int64_t i = 0; i < zip_get_num_entries(archive, 0); ++i)
      result.emplace_back(zip_get_name(archive, static_cast<zip_uint64_t>(i), 0));
    return result;
  }
  std::string read(const std::string& name) const {
    zip_stat_t stat;
    zip_file_t* file = zip_fopen(archive, name.c_str(), 0);
    if (!file || zip_stat(archive, name.c_str(), 0, &stat) != 0)
      return "missing";
    std::string content(stat.size, '\0');
    EXPECT_EQ(zip_fread(file, content.data(), stat.size), static_cast<zip_int64_t>(stat.size));
    zip_fclose(file);
    return content;
  }

  zip_t* archive;
};

TEST_F(PhantomSceneFiles, ArchiveHasSceneAndDataInSlicerLayout) {
  const ZipFile zip(folder / "knee.mrb");
  ASSERT_TRUE(zip.archive);
  EXPECT_EQ(zip.names(), (std::vector<std::string>{"knee/knee.mrml", "knee/Data/knee.nrrd",
                                                   "knee/Data/knee.seg.nrrd", "knee/Data/knee.vp",
                                                   "knee/Data/knee-roi.mrk.json"}));
  for (const char* name : {"knee.nrrd", "knee.seg.nrrd", "knee.vp", "knee-roi.mrk.json"})
    EXPECT_EQ(zip.read(std::string("knee/Data/") + name), readBytes(folder / name)) << name;
  pugi::xml_document archived;
  ASSERT_TRUE(archived.load_string(zip.read("knee/knee.mrml").c_str()));
  std::size_t same = 0;
  for (const pugi::xml_node& child : scene.children()) {
    const pugi::xml_node other = archived.child("MRML").child(child.name());
    for (const pugi::xml_attribute& attribute : child.attributes()) {
      const bool isFile = std::string(attribute.name()) == "fileName";
      EXPECT_EQ(other.attribute(attribute.name()).value(),
                (isFile ? "Data/" : "") + std::string(attribute.value()));
      ++same;
    }
  }
  EXPECT_GT(same, 250u);
}

TEST_F(PhantomSceneFiles, ArchiveHasFixedDate) {
  const ZipFile zip(folder / "knee.mrb");
  ASSERT_TRUE(zip.archive);
  for (const std::string& name : zip.names()) {
    zip_stat_t stat;
    ASSERT_EQ(zip_stat(zip.archive, name.c_str(), 0, &stat), 0);
    const std::tm* date = std::localtime(&stat.mtime); // zip stores no time zone
    EXPECT_EQ(date->tm_year + 1900, 1980) << name;
    EXPECT_EQ(date->tm_yday, 0) << name;
  }
}

TEST_F(PhantomSceneFiles, FilesAreReproducible) {
  const TemporaryFolder again;
  writePhantom(phantom, again.path(), "knee");
  EXPECT_EQ(files.size(), 7u);
  for (const std::string& file : files)
    EXPECT_EQ(readBytes(folder / file), readBytes(again / file)) << file;
}

TEST(PhantomScene, EscapesReservedCharactersOfXmlAndUrls) {
  Phantom phantom = makeCubePhantom({1.0, 16});
  phantom.segments[0].id = "a b|c";
  const std::string text = makePhantomScene(phantom, "R&D <\"1\">", "my file%1/");
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(text.c_str()));
  const pugi::xml_node scene = document.child("MRML");
  EXPECT_STREQ(scene.child("Volume").attribute("name").value(), "R&D <\"1\">");
  EXPECT_STREQ(scene.child("VolumeArchetypeStorage").attribute("fileName").value(),
               "my%20file%251/R%26D%20%3C%221%22%3E.nrrd");
  EXPECT_TRUE(
      std::string(
          scene.child("SegmentationDisplay").attribute("SegmentationDisplayProperties").value())
          .starts_with("a%20b%7Cc OverrideColorR"));
}

TEST(PhantomScene, PropertyOpacitiesArePerMillimeter) {
  const auto readOpacity = [](double edge) {
    const std::string text = makePhantomScene(makeCubePhantom({edge, 16}), "cube");
    pugi::xml_document document;
    EXPECT_TRUE(document.load_string(text.c_str()));
    return readNumbers(document.child("MRML").child("VolumeProperty"), "scalarOpacity").at(2);
  };
  EXPECT_NEAR(readOpacity(100.0), 0.99, 1e-12); // the unit is 1/100 of the edge
  EXPECT_NEAR(readOpacity(200.0), 1.0 - std::sqrt(0.01), 1e-12);
  EXPECT_NEAR(readOpacity(50.0), 0.9999, 1e-12);
}

} // namespace
} // namespace fenestra::core::PhantomSceneTests
