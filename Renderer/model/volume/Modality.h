#pragma once

namespace fenestra {

/// Kind of scan. CT's scalars are Hounsfield units; MR and ultrasound have no unit of their own.
enum class Modality { ct, mr, us };

} // namespace fenestra
