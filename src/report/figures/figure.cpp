#include "rift/report/figures/figure.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>

#include "rift/files/files.hpp"
#include "rift/files/process_end.hpp"

namespace rift::report {
namespace {

// Anonymous files instead of pipes: a large script cannot block on a child that is itself blocked
// on its output, and a child that dies early raises no SIGPIPE.
class ScratchFile {
 public:
  ScratchFile() : file_(std::tmpfile(), &std::fclose) {
    if (!file_) throw Failure("cannot make a temporary file for gnuplot");
  }

  int Descriptor() const { return fileno(file_.get()); }

  void Write(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size() ||
        std::fflush(file_.get()) != 0) {
      throw Failure("cannot write the script for gnuplot");
    }
    std::rewind(file_.get());
  }

  std::string ReadAll() {
    std::rewind(file_.get());
    std::string text;
    std::array<char, 1 << 16> block;
    while (const std::size_t n = std::fread(block.data(), 1, block.size(), file_.get())) {
      text.append(block.data(), n);
    }
    return text;
  }

 private:
  static std::runtime_error Failure(const char* what) {
    return std::runtime_error(fmt::format("{}: {}", what, std::strerror(errno)));
  }

  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

class SpawnActions {
 public:
  SpawnActions() { posix_spawn_file_actions_init(&actions_); }
  ~SpawnActions() { posix_spawn_file_actions_destroy(&actions_); }
  SpawnActions(const SpawnActions&) = delete;
  SpawnActions& operator=(const SpawnActions&) = delete;

  void Connect(const ScratchFile& file, int to_descriptor) {
    posix_spawn_file_actions_adddup2(&actions_, file.Descriptor(), to_descriptor);
  }
  const posix_spawn_file_actions_t* Get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

int SpawnAndWait(const SpawnActions& actions) {
  // --default-settings: a user's ~/.gnuplot must not change the figures.
  std::string program = "gnuplot", defaults = "--default-settings";
  std::array<char*, 3> arguments = {program.data(), defaults.data(), nullptr};
  pid_t child = 0;
  const int error =
      posix_spawnp(&child, program.c_str(), actions.Get(), nullptr, arguments.data(), environ);
  if (error == ENOENT) {
    throw std::runtime_error(
        "figures need gnuplot, which is not installed: apt-get install gnuplot-nox");
  }
  if (error != 0) {
    throw std::runtime_error(fmt::format("cannot start gnuplot: {}", std::strerror(error)));
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) {
      throw std::runtime_error(fmt::format("lost gnuplot: {}", std::strerror(errno)));
    }
  }
  return status;
}

// gnuplot echoes the command and a caret line before the message; one line is enough for us.
std::string OnOneLine(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const bool space = std::isspace(static_cast<unsigned char>(c)) != 0;
    if (!space) line += c;
    if (space && !line.empty() && line.back() != ' ') line += ' ';
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

/// What gnuplot writes to its standard output for a script on its standard input.
/// Throws std::runtime_error when it is not installed or complains.
std::string RunGnuplot(const std::string& script) {
  ScratchFile input, output, complaints;
  input.Write(script);
  SpawnActions actions;
  actions.Connect(input, STDIN_FILENO);
  actions.Connect(output, STDOUT_FILENO);
  actions.Connect(complaints, STDERR_FILENO);
  const int status = SpawnAndWait(actions);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw std::runtime_error(
        fmt::format("gnuplot {}", files::ProcessEndText(status, OnOneLine(complaints.ReadAll()))));
  }
  return output.ReadAll();
}

// noenhanced: an underscore in a surface's name is an underscore, not a subscript.
std::string Terminal(const Figure& figure, FigureFormat format, const ReportOptions& options) {
  if (format == FigureFormat::kSvg) {
    return fmt::format(
        "set terminal svg noenhanced size {},{} font 'Arial,{}' background '#ffffff'\n",
        figure.width_px, figure.height_px, options.font_pt);
  }
  const int scale = options.png_scale;
  // cairo draws at 72 points an inch and SVG viewers at 96, hence 0.75 and 4/3.
  return fmt::format(
      "set terminal pngcairo noenhanced size {},{} font 'DejaVu Sans,{}' fontscale {:g} "
      "linewidth {} pointscale {} background '#ffffff'\n",
      scale * figure.width_px, scale * figure.height_px, options.font_pt, 0.75 * scale, scale,
      scale);
}

constexpr std::string_view kStyle =
    "set border 3 lw 0.8 lc rgb '#444444'\n"
    "set tics nomirror out scale 0.5\n"
    "set grid lw 0.5 lc rgb '#DDDDDD'\n"
    "set style fill solid 0.9 noborder\n"
    "set key outside top center horizontal Left reverse samplen 2 spacing 1.1 width -1\n";

bool IsWhole(const std::string& image, FigureFormat format) {
  const std::string_view end = format == FigureFormat::kSvg ? "</svg>" : "IEND";
  const std::string_view tail =
      std::string_view(image).substr(image.size() - std::min<std::size_t>(image.size(), 16));
  return tail.find(end) != std::string_view::npos;
}

}  // namespace

std::string GnuplotScript(const Figure& figure, FigureFormat format, const ReportOptions& options) {
  return fmt::format("set encoding utf8\n{}{}{}", Terminal(figure, format, options), kStyle,
                     figure.plot);
}

std::string Render(const Figure& figure, FigureFormat format, const ReportOptions& options) {
  std::string image;
  try {
    image = RunGnuplot(GnuplotScript(figure, format, options));
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("figure {}: {}", figure.name, error.what()));
  }
  if (!IsWhole(image, format)) {
    throw std::runtime_error(fmt::format("figure {}: gnuplot wrote {} bytes that are no whole {}",
                                         figure.name, image.size(),
                                         EnumNames(format)[static_cast<int>(format)]));
  }
  return image;
}

Figure Stack(std::string name, std::string title, const std::vector<Figure>& figures) {
  Figure stack{std::move(name), std::move(title), 0, 0, "set multiplot\n"};
  for (const Figure& figure : figures) {
    stack.width_px = std::max(stack.width_px, figure.width_px);
    stack.height_px += figure.height_px;
  }
  int top_px = stack.height_px;
  for (const Figure& figure : figures) {
    top_px -= figure.height_px;
    stack.plot += fmt::format("reset\n{}set size 1,{:.9g}\nset origin 0,{:.9g}\n{}", kStyle,
                              static_cast<double>(figure.height_px) / stack.height_px,
                              static_cast<double>(top_px) / stack.height_px, figure.plot);
  }
  stack.plot += "unset multiplot\n";
  return stack;
}

namespace {

FigureFormat FormatOf(const std::filesystem::path& path) {
  if (path.extension() == ".svg") return FigureFormat::kSvg;
  if (path.extension() == ".png") return FigureFormat::kPng;
  throw std::invalid_argument("--figure " + path.string() + ": the name must end in .svg or .png");
}

}  // namespace

void RequireFigureName(const std::filesystem::path& path) { FormatOf(path); }

void WriteFigure(const std::filesystem::path& path, const Figure& figure) {
  files::WriteFile(path, Render(figure, FormatOf(path)));
}

void WriteFigureFiles(const std::filesystem::path& folder, const Figure& figure) {
  for (const char* extension : {".svg", ".png"}) {
    WriteFigure(folder / (figure.name + extension), figure);
  }
}

}  // namespace rift::report
