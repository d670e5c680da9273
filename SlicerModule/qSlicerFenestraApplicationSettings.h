#ifndef __qSlicerFenestraApplicationSettings_h
#define __qSlicerFenestraApplicationSettings_h

#include <QStringList>

/// \brief The module's part of Slicer's settings, which qSlicerFenestraSettingsPanel edits. They
/// apply to the next process that is started.
///
/// Anybody may have edited the settings, so that invalid values count as the defaults.
namespace qSlicerFenestraApplicationSettings {

constexpr const char* threadsKey = "Fenestra/Threads";                 ///< 0: all cores
constexpr const char* deviceKey = "Fenestra/Device";                   ///< auto, cpu or gpu
constexpr const char* executableKey = "Fenestra/Executable";           ///< empty: the installed one
constexpr const char* temporaryFolderKey = "Fenestra/TemporaryFolder"; ///< empty: that of Slicer

/// The renderer to start instead of `installed`, or `installed`.
QString findProgram(const QString& installed);
/// Options of all commands that render.
QStringList makeThreadArguments();
QStringList makeDeviceArguments();
/// Empty or unusable setting: Slicer's own folder for temporary files.
QString findTemporaryFolder();
/// True if files can be created in the folder.
bool isUsableFolder(const QString& folder);

} // namespace qSlicerFenestraApplicationSettings

#endif
