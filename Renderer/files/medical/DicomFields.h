#pragma once
// The fields of DicomHeader, in the order in which the child sends them (DicomRequests.cxx) and the
// parent reads them (DicomReader.cxx). Several fields may set one member: the last that the file
// states does.

#include "files/medical/DicomReader.h"

#include <array>
#include <variant>

namespace fenestra::core {

/// Encoding of a value: text, or numbers of these DICOM types.
enum class DicomValue { text, us, ul, fl, fd };

struct DicomField {
  std::uint32_t tag;
  std::variant<std::string DicomHeader::*, std::vector<double> DicomHeader::*,
               double DicomHeader::*, unsigned DicomHeader::*, std::optional<double> DicomHeader::*>
      member;
  DicomValue value = DicomValue::text;
  /// Sequence whose first item has the value: in the functional groups of a frame, or in the data
  /// set; 0: none.
  std::uint32_t sequence = 0;
  bool isInSequenceOnly = false; ///< elsewhere the tag means something else
  const char* creator = "";      ///< of a private tag
};

inline constexpr auto dicomFields = [] {
  using H = DicomHeader;
  using enum DicomValue;
  return std::to_array<DicomField>({
      {0x00080005, &H::characterSet},
      {0x00080008, &H::imageType},
      {0x00089007, &H::imageType, text, 0x00189329}, // of a CT frame
      {0x00089007, &H::imageType, text, 0x00189226}, // of an MR frame
      {0x00089007, &H::imageType, text, 0x00189751}, // of a PET frame
      {0x00080016, &H::sopClass},
      {0x00080018, &H::sopUid},
      {0x00080021, &H::seriesDate},
      {0x00080022, &H::acquisitionDate},
      {0x00080031, &H::seriesTime},
      {0x00080032, &H::acquisitionTime},
      {0x00080060, &H::modality},
      {0x0008103e, &H::seriesDescription},
      {0x00101030, &H::weight},
      {0x00180010, &H::contrastAgent},
      {0x00180050, &H::sliceThickness, text, 0x00289110},
      {0x00180081, &H::echoTime},
      {0x00189082, &H::echoTime, fd, 0x00189114},
      {0x00180088, &H::sliceSpacing, text, 0x00289110},
      {0x00181060, &H::triggerTime},
      {0x00181072, &H::injectionTime, text, 0x00540016},
      {0x00181074, &H::dose, text, 0x00540016},
      {0x00181075, &H::halfLife, text, 0x00540016},
      {0x00181078, &H::injectionDateTime, text, 0x00540016},
      {0x00181210, &H::convolutionKernel, text, 0x00189314},
      {0x00209153, &H::triggerTime, fd, 0x00189118},
      {0x00209241, &H::cardiacPhase, fd, 0x00189118},
      {0x0019100c, &H::bValue, text, 0, false, "SIEMENS MR HEADER"},
      {0x00431039, &H::bValue, text, 0, false, "GEMS_PARM_01"},
      {0x20011003, &H::bValue, fl, 0, false, "Philips Imaging DD 001"},
      {0x00189087, &H::bValue, fd, 0x00189117},
      {0x0020000e, &H::seriesUid},
      {0x0020000e, &H::referencedSeries, text, 0x00081115, true},
      {0x00200011, &H::seriesNumber},
      {0x00200012, &H::acquisition},
      {0x00200013, &H::instance},
      {0x00200032, &H::position, text, 0x00540022}, // of a detector, nuclear medicine
      {0x00200032, &H::position, text, 0x00209113},
      {0x00209301, &H::position, fd, 0x0020930e}, // ultrasound volumes
      {0x00200037, &H::orientation, text, 0x00540022},
      {0x00200037, &H::orientation, text, 0x00209116},
      {0x00209302, &H::orientation, fd, 0x0020930f},
      {0x00200052, &H::frameOfReference},
      {0x00200052, &H::frameOfReference, text, 0x30060010},
      {0x00200100, &H::temporalPosition},
      {0x00209128, &H::temporalPosition, ul, 0x00209111},
      {0x00280002, &H::samples, us},
      {0x00280004, &H::photometric},
      {0x00280008, &H::frames},
      {0x00280010, &H::rows, us},
      {0x00280011, &H::columns, us},
      {0x00280030, &H::pixelSpacing, text, 0x00289110},
      {0x00280100, &H::bits, us},
      {0x00280101, &H::bitsStored, us},
      {0x00280102, &H::highBit, us},
      {0x00280103, &H::isSigned, us},
      {0x00281052, &H::intercept, text, 0x00289145},
      {0x00281053, &H::slope, text, 0x00289145},
      {0x00540080, &H::sliceVector, us},
      {0x00541001, &H::units},
      {0x00541102, &H::decayCorrection},
  });
}();

/// Request to a child: its first character, then for voxels the frame (4 bytes), then the path.
inline constexpr char dicomHeaderRequest = 'h', dicomVoxelsRequest = 'v';

extern const SandboxJob dicomJob, dicomFramesJob;

} // namespace fenestra::core
