#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace continuum {

/// The file that writing to path changes: the end of its symbolic links, whether it exists or not.
std::filesystem::path ThroughLinks(const std::filesystem::path& path);

/// Pipes, terminals and other devices; and standard output, also when it happens to be a file.
bool IsStream(const std::filesystem::path& path);

/// Throws Error for a file that may never end (a pipe, a device), a folder and what memory cannot
/// hold. One that does not exist is left to its reader.
void RequireFile(const std::filesystem::path& path);

/// The whole file as text. Throws Error when it cannot be read.
std::string ReadFile(const std::filesystem::path& path);

/// Writes the whole file or nothing (aside, then renamed); follows symbolic links, writes pipes and
/// devices in place. Throws Error when the folder is missing, not writable or full.
void WriteFile(const std::filesystem::path& path, std::string_view content);
/// The same; without content it removes the file that an earlier job left there.
void WriteOrRemove(const std::filesystem::path& path, std::string_view content);

/// Creates the folder (and its parents). Throws Error when that is impossible.
void MakeFolder(const std::filesystem::path& path);

/// A temporary name beside path, for writers that need a real file; rename it over path when done.
/// What processes that were killed left behind under such names is removed.
std::filesystem::path TemporaryPath(const std::filesystem::path& path);

}  // namespace continuum
