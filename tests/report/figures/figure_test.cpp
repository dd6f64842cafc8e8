#include "rift/report/figures/figure.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <stdexcept>

#include "report/png.hpp"

namespace rift::report {
namespace {

using Catch::Matchers::Contains;

Figure Plot(const std::string& commands) { return {"figure", "", 300, 200, commands}; }

TEST_CASE("A figure becomes the SVG gnuplot draws") {
  const std::string svg = Render(Plot("set xlabel 'some_unit (m)'\nplot x\n"), FigureFormat::kSvg);
  CHECK_THAT(svg, Contains("<svg") && Contains("some_unit (m)") && Contains("</svg>"));
}

TEST_CASE("A figure becomes a PNG that is not blank") {
  const std::string png = Render(Plot("plot x\n"), FigureFormat::kPng);
  CHECK(PngSize(png) == std::pair(900, 600));
  CHECK(png.size() >
        Render(Plot("unset border\nunset tics\nunset key\nplot [0:1] -1\n"), FigureFormat::kPng)
            .size());
}

TEST_CASE("A picture has the size, font and scale of its figure and options") {
  const ReportOptions options{.font_pt = 13, .png_scale = 2};
  const Figure figure = Plot("plot x\n");
  const std::string svg = GnuplotScript(figure, FigureFormat::kSvg, options);
  CHECK_THAT(svg, Contains("set encoding utf8\nset terminal svg noenhanced size 300,200 font "
                           "'Arial,13' background '#ffffff'\n"));
  CHECK_THAT(svg, Contains("set border 3 ") && Catch::Matchers::EndsWith("\nplot x\n"));
  // Cairo draws at 72 points an inch, of which an SVG has 96 pixels.
  CHECK_THAT(GnuplotScript(figure, FigureFormat::kPng, options),
             Contains("set terminal pngcairo noenhanced size 600,400 font 'DejaVu Sans,13' "
                      "fontscale 1.5 linewidth 2 pointscale 2 background '#ffffff'\n"));
}

TEST_CASE("A figure's file is what its name ends in, and another ending is refused") {
  CHECK_NOTHROW(RequireFigureName("a.svg"));
  CHECK_NOTHROW(RequireFigureName("a.b/c.png"));
  for (const char* name : {"a.pdf", "a", "svg", "a.svg.gz", "a.SVG"}) {
    CHECK_THROWS_WITH(RequireFigureName(name),
                      std::string("--figure ") + name + ": the name must end in .svg or .png");
  }
}

TEST_CASE("The same figure gives the same bytes") {
  for (const FigureFormat format : {FigureFormat::kSvg, FigureFormat::kPng}) {
    CHECK(Render(Plot("plot sin(x)\n"), format) == Render(Plot("plot sin(x)\n"), format));
  }
}

TEST_CASE("What gnuplot complains about reaches the caller with the name of the figure") {
  CHECK_THROWS_WITH(Render(Plot("plot nosuchvariable\n"), FigureFormat::kSvg),
                    Contains("figure figure") && Contains("undefined variable: nosuchvariable"));
}

TEST_CASE("A script that draws nothing is no image") {
  CHECK_THROWS_WITH(Render(Plot("x = 1\n"), FigureFormat::kPng),
                    "figure figure: gnuplot wrote 0 bytes that are no whole png");
}

TEST_CASE("A missing gnuplot is named with the package that holds it") {
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  std::string message;
  try {
    Render(Plot("plot x\n"), FigureFormat::kSvg);
  } catch (const std::runtime_error& error) {
    message = error.what();
  }
  setenv("PATH", path.c_str(), 1);
  CHECK_THAT(message, Contains("apt-get install gnuplot-nox"));
}

TEST_CASE("A stack holds every figure at its own height") {
  Figure tall = Plot("set xlabel 'upper'\nplot x\n"), low = Plot("set xlabel 'lower'\nplot x\n");
  low.height_px = 100;
  const Figure stack = Stack("all", "", {tall, low});
  CHECK(stack.height_px == 300);
  CHECK(stack.width_px == 300);
  // From the top down, and from the bottom up as gnuplot counts.
  CHECK_THAT(stack.plot, Contains("set size 1,0.666666667\nset origin 0,0.333333333\nset xlabel "
                                  "'upper'") &&
                             Contains("set size 1,0.333333333\nset origin 0,0\nset xlabel "
                                      "'lower'"));
  low.width_px = 340;
  CHECK(Stack("all", "", {tall, low, tall}).width_px == 340);
  const std::string svg = Render(stack, FigureFormat::kSvg);
  CHECK_THAT(svg, Contains("upper") && Contains("lower"));
}

TEST_CASE("A complaint of several lines is told in one, without blanks at its end") {
  std::string message;
  try {
    Render(Plot("plot nosuchvariable\n"), FigureFormat::kSvg);
  } catch (const std::runtime_error& error) {
    message = error.what();
  }
  CHECK_THAT(message, Catch::Matchers::StartsWith("figure figure: gnuplot ") && !Contains("\n") &&
                          !Contains("  "));
  REQUIRE_FALSE(message.empty());
  CHECK(message.back() != ' ');
}

}  // namespace
}  // namespace rift::report
