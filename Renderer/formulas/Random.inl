// Random numbers: hashes of a counter, and the strata of a pixel's samples (base/Sampler.h).

/// Bit mixer for 32 bits with low bias (the Hash Prospector project).
FORMULA UInt mixBits(UInt x) {
  x = (x ^ SHIFT_RIGHT(x, 16)) * 0x21f0aaadU;
  x = (x ^ SHIFT_RIGHT(x, 15)) * 0x735a2d97U;
  return x ^ SHIFT_RIGHT(x, 15);
}
/// Counter of a stream's next random bits, which are mixBits(counter).
FORMULA UInt nextCounter(UInt counter) {
  return counter + 0x9e3779b9U;
}

/// Word n of a Sampler::Stream.
FORMULA UInt streamWord(UInt start, UInt key, UInt n) {
  return mixBits((start + n * 0x9e3779b9U) ^ key);
}
/// First of a sample's sixteen words: position (two words), depth, acceptance, direction (two),
/// choices (two), seed (two), and the low bits of depth and acceptance.
FORMULA UInt firstWordOfSample(UInt number) {
  return number * 16U;
}

/// Index of a sample in its block of eight samples of a half buffer.
FORMULA UInt indexInBlock(UInt number) {
  return SHIFT_RIGHT(number, 1) & 7U;
}
/// Word that shuffles the strata of one of four pairs of numbers, the same for a block: one of the
/// last words of its first sample.
FORMULA UInt wordOfShuffle(UInt number, UInt index, UInt pair) {
  return firstWordOfSample(number - (index + index)) + (pair + 12U);
}
/// Place in Sampler::nets of a sample's strata, which `shuffle` is added to by XOR.
FORMULA UInt placeInNets(UInt shuffle, UInt index) {
  return (shuffle & 7U) * 8U + index;
}
/// Replaces the three leading bits of a word by those of `strata`.
FORMULA UInt replaceLeading(UInt strata, UInt word) {
  return (strata & 0xe0000000U) ^ SHIFT_RIGHT(word, 3);
}
/// Strata of a pair's second number.
FORMULA UInt nextStrata(UInt strata) {
  return SHIFT_LEFT(strata, 3);
}
