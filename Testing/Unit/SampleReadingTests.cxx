// Reads samples of a file in blocks into the smallest type that can hold all of them.

#include "files/medical/VolumeReader.h"

#include "MedicalFiles.h"
#include "files/medical/SampleSource.h"
#include "files/medical/SampleStore.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace fenestra::core::SampleReadingTests {
namespace {

constexpr std::size_t count = 600'000; // several blocks, of which the last is partial
const std::string sizes = "100 100 60";

using Store = SampleStore<std::uint8_t, std::int16_t, std::uint16_t, float>;

/// Small integers, except one sample near the end.
template <typename T>
std::vector<T> makeSamples(T outlier) {
  std::vector<T> samples(count);
  for (std::size_t i = 0; i < count; ++i)
    samples[i] = static_cast<T>(i % 200);
  samples[count - 100] = outlier;
  return samples;
}

template <typename T>
Store::Vectors storeSamples(const std::vector<T>& samples) {
  std::size_t position = 0;
  const SampleSource source{
      .type = T(), .count = samples.size(), .read = [&](void* to, std::size_t bytes) {
        std::memcpy(to, samples.data() + position, bytes);
        position += bytes / sizeof(T);
      }};
  Store store(source.count);
  readSamples(source, store);
  const std::array<double, 2> range = store.range();
  Store::Vectors vectors = store.take();
  std::visit(
      [&](const auto& values) {
        const auto [low, high] = std::minmax_element(values.begin(), values.end());
        EXPECT_EQ(range[0], static_cast<double>(*low));
        EXPECT_EQ(range[1], static_cast<double>(*high));
      },
      vectors);
  return vectors;
}

template <typename Stored, typename T>
void expectStoredAs(T outlier) {
  const std::vector<T> samples = makeSamples(outlier);
  const Store::Vectors vectors = storeSamples(samples);
  ASSERT_TRUE(std::holds_alternative<LargeArray<Stored>>(vectors)) << outlier;
  const auto& stored = std::get<LargeArray<Stored>>(vectors);
  ASSERT_EQ(stored.size(), samples.size());
  for (std::size_t i = 0; i < count; ++i)
    ASSERT_EQ(static_cast<double>(stored[i]), static_cast<double>(static_cast<Stored>(samples[i])))
        << i;
}

TEST(SampleReading, LateSampleConvertsEarlierBlocks) {
  expectStoredAs<std::uint8_t, std::int32_t>(255);
  expectStoredAs<std::int16_t, std::int32_t>(-1);
  expectStoredAs<std::int16_t, std::int32_t>(32767);
  expectStoredAs<std::uint16_t, std::int32_t>(32768);
  expectStoredAs<float, std::int32_t>(65536);
  expectStoredAs<float, std::int64_t>(std::int64_t{1} << 40);
  expectStoredAs<std::uint8_t, float>(255.0f);
  expectStoredAs<float, float>(0.5f);
  expectStoredAs<float, double>(0.1);
}

TEST(SampleReading, CanConvertMoreThanOnce) {
  std::vector<std::int32_t> samples = makeSamples<std::int32_t>(-7);
  samples[300'000] = 40'000; // to uint16; the negative sample then requires float
  const Store::Vectors vectors = storeSamples(samples);
  const auto& stored = std::get<LargeArray<float>>(vectors);
  EXPECT_TRUE(std::equal(stored.begin(), stored.end(), samples.begin(), samples.end(),
                         [](float a, std::int32_t b) { return a == static_cast<float>(b); }));
}

TEST(SampleReading, ReplacesNonFiniteSamplesInAnyBlock) {
  for (const float outlier : {0.5f, 7.0f}) { // stays float; can be stored as integers
    std::vector<float> samples = makeSamples(outlier);
    samples[3] = std::numeric_limits<float>::quiet_NaN();
    samples[400'000] = std::numeric_limits<float>::infinity();
    samples[count - 1] = -std::numeric_limits<float>::infinity();
    const Store::Vectors vectors = storeSamples(samples);
    EXPECT_EQ(vectors.index(), outlier == 0.5f ? 3u : 0u);
    std::visit(
        [&](const auto& stored) {
          ASSERT_EQ(stored.size(), count);
          for (std::size_t i = 0; i < count; ++i) {
            const float expected = std::isnan(samples[i])   ? 0.0f
                                   : std::isinf(samples[i]) ? (samples[i] > 0 ? 199.0f : 0.0f)
                                                            : samples[i];
            ASSERT_EQ(static_cast<float>(stored[i]), expected) << i;
          }
        },
        vectors);
  }
}

TEST(SampleReading, ReportsSamplesThatNoTypeCanHold) {
  SampleStore<std::uint8_t, std::int16_t> store(2);
  const std::vector<float> samples = {1.0f, 0.5f};
  store.append(std::span(samples), computeStats(std::span(samples)));
  EXPECT_FALSE(store.canHoldAll());
}

// ---- files

std::string deflateBytes(const std::string& bytes, int windowBits) {
  z_stream stream{};
  deflateInit2(&stream, 1, Z_DEFLATED, windowBits, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, uLong(bytes.size())) + 32, '\0');
  std::string in = bytes;
  stream.next_in = reinterpret_cast<Bytef*>(in.data());
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

std::string compressZlib(const std::string& bytes) {
  return deflateBytes(bytes, 15);
}
std::string compressGzip(const std::string& bytes) {
  return deflateBytes(bytes, 15 + 16);
}

std::string makeNrrdHeader(const std::string& encoding, const std::string& endian) {
  return "NRRD0004\ntype: short\ndimension: 3\nsizes: " + sizes + "\nencoding: " + encoding +
         "\nendian: " + endian + "\n\n";
}

std::string makeMetaHeader(const std::string& fields) {
  return "ObjectType = Image\nNDims = 3\nDimSize = " + sizes + "\n" + fields +
         "ElementType = MET_SHORT\nElementDataFile = LOCAL\n";
}

TEST(SampleReading, ReadsBothByteOrdersInEveryEncoding) {
  const std::vector<std::int16_t> samples = makeSamples<std::int16_t>(-1000);
  std::vector<std::int16_t> swapped = samples;
  for (std::int16_t& x : swapped)
    x = static_cast<std::int16_t>(__builtin_bswap16(static_cast<std::uint16_t>(x)));
  constexpr bool isLittle = std::endian::native == std::endian::little;
  const std::string little = rawBytes(isLittle ? samples : swapped);
  const std::string big = rawBytes(isLittle ? swapped : samples);
  const TemporaryFolder folder;
  for (const auto& path : {
           folder.write("raw-little.nrrd", makeNrrdHeader("raw", "little") + little),
           folder.write("raw-big.nrrd", makeNrrdHeader("raw", "big") + big),
           folder.write("gzip-little.nrrd",
                        makeNrrdHeader("gzip", "little") + compressGzip(little)),
           folder.write("gzip-big.nrrd", makeNrrdHeader("gzip", "big") + compressGzip(big)),
           folder.write("raw-little.mha",
                        makeMetaHeader("BinaryDataByteOrderMSB = False\n") + little),
           folder.write("raw-big.mha", makeMetaHeader("ElementByteOrderMSB = True\n") + big),
           folder.write("raw-native.mha", makeMetaHeader("") + rawBytes(samples)),
           folder.write("zlib-little.mha",
                        makeMetaHeader("BinaryDataByteOrderMSB = 0\nCompressedData = True\n") +
                            compressZlib(little)),
           folder.write("zlib-big.mha",
                        makeMetaHeader("BinaryDataByteOrderMSB = 1\nCompressedData = True\n") +
                            compressZlib(big)),
       }) {
    const Volume volume = readVolume(path);
    EXPECT_TRUE(std::ranges::equal(std::get<LargeArray<std::int16_t>>(volume.voxels), samples))
        << path;
    EXPECT_EQ(volume.minimum, -1000.0);
    EXPECT_EQ(volume.maximum, 199.0);
  }
}

TEST(SampleReading, RefusesStreamsOfWrongLength) {
  const TemporaryFolder folder;
  const std::string samples = rawBytes(makeSamples<std::int16_t>(-1000));
  const auto refuse = [&](const std::string& name, const std::string& content) {
    const auto path = folder.write(name, content);
    expectRefused(path, "damaged-file", [&] { readVolume(path); });
  };
  const std::string compressed = compressGzip(samples);
  const std::string head = makeNrrdHeader("gzip", "little");
  refuse("short.nrrd", head + compressGzip(samples.substr(2)));
  refuse("long.nrrd", head + compressGzip(samples + "x"));
  refuse("cut.nrrd", head + compressed.substr(0, compressed.size() - 3));
  std::string corrupted = compressed;
  corrupted[corrupted.size() - 8] =
      static_cast<char>(~corrupted[corrupted.size() - 8]); // byte of the checksum
  refuse("checksum.nrrd", head + corrupted);
  refuse("cut.mha",
         makeMetaHeader("CompressedData = True\n") + compressZlib(samples).substr(0, 5000));
}

} // namespace
} // namespace fenestra::core::SampleReadingTests
