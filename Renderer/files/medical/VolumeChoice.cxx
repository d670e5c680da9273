#include "files/medical/VolumeChoice.h"

namespace fenestra::core {

std::size_t chooseFrame(const std::string& subject, std::optional<std::size_t> frame,
                        std::size_t count, std::vector<Message>& warnings) {
  if (frame.value_or(0) >= count)
    throw inputError(ErrorCode::unknownFrame, subject, "has no frame ", *frame, ": it has ", count,
                     count == 1 ? " frame" : " frames, counted from 0");
  if (!frame && count > 1)
    warnings.push_back(makeMessage(ErrorCode::assumedFrame, subject, "has ", count,
                                   " frames, of which the first is used"));
  return frame.value_or(0);
}

void refuseForm(const std::string& subject, const VolumeChoice& choice) {
  if (choice.niftiForm)
    throw inputError(ErrorCode::unknownForm, subject,
                     "is no NIfTI file, so it has no qform or sform");
}

void refuseSpacing(const std::string& subject, const VolumeChoice& choice) {
  if (choice.spacing)
    throw inputError(ErrorCode::invalidValue, subject,
                     "states its own voxel spacing, so none may be given");
}

} // namespace fenestra::core
