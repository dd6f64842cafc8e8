#pragma once

#include <sys/types.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "rift/files/descriptor.hpp"

namespace rift::sweep {

/// How a program that is not rift is started: never by a shell.
struct ProgramStart {
  std::vector<std::string> arguments;              ///< the first is looked for in PATH
  std::map<std::string, std::string> environment;  ///< on top of the caller's
  std::map<std::string, std::string> files;        ///< in its folder before it starts
  int memory_mb = 1024;                            ///< what it may take, in 2^20 bytes
  /// Its stdin and stdout are pipes to the caller; else it reads nothing and stdout goes nowhere.
  bool talks = false;
};

/// What a row keeps of what a program says of itself: the first line of it, at most 200 bytes, no
/// character of UTF-8 in pieces.
std::string ShortWords(std::string text);

/// A running program with all processes that it starts, in a temporary folder of its own, which is
/// its working directory.
///
/// A keeper process stands between the caller and the program: what the program leaves behind, in
/// whatever session, becomes the keeper's child (PR_SET_CHILD_SUBREAPER). When the caller is done
/// with the program, or dies in whatever way, the keeper kills them all and removes the folder.
class ExternalProgram {
 public:
  /// A new empty folder. Throws MachineTrouble when none can be made.
  static std::string MakeFolder();

  /// Takes the folder over. Throws MachineTrouble when its files cannot be written or no process
  /// can be made.
  ExternalProgram(const ProgramStart& start, std::string folder);
  /// Returns when no process of it is left and the folder is gone.
  ~ExternalProgram();
  ExternalProgram(const ExternalProgram&) = delete;
  ExternalProgram& operator=(const ExternalProgram&) = delete;

  struct Exit {
    int code = 0;    ///< 127 when it could not be started, as its stderr says
    int signal = 0;  ///< that ended it; 0: none
  };
  /// Waits for the program itself. Throws MachineTrouble when there was no process for it.
  Exit Wait();
  /// True of an end, with LastWords(), of one that was never started: it is not there, or cannot be
  /// executed, on this machine.
  static bool WasNeverStarted(const Exit& exit, const std::string& last_words);

  /// Sends a line to one that talks; false when it does not listen.
  bool SendLine(const std::string& line);
  /// The next line of one that talks; nothing when it has closed its stdout.
  std::optional<std::string> ReceiveLine();
  /// Begins the next line to it with that byte, as the line must, and waits until it takes that, in
  /// ms; negative: for ever. What it has written by then that nobody has received, or the beginning
  /// of it; empty: nothing. Who reads the next line has written all about the one before.
  const std::string& UnreadAtNextLine(char first, int most_ms);

  /// The last line that it wrote to stderr, of whose end 64 kB are read, as ShortWords, the folder
  /// in it as {folder}. Where Node has ended it with a stack and its version, the error above them.
  std::string LastWords() const;
  /// Forgets what it wrote to stderr until now.
  void ForgetWords();

  const std::string& Folder() const { return folder_; }
  /// The process that started it: of a copy of that process it is not.
  pid_t Owner() const { return owner_; }

 private:
  void TakeArrived();

  std::string folder_;
  pid_t owner_ = -1;
  pid_t keeper_ = -1;
  files::Descriptor control_;  ///< to the keeper, which ends when it is closed
  files::Descriptor to_program_;
  files::Descriptor from_program_;
  std::string arrived_;
  bool has_begun_line_ = false;
};

}  // namespace rift::sweep
