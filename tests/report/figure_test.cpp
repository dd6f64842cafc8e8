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
  CHECK_THROWS_WITH(Render(Plot("x = 1\n"), FigureFormat::kPng), Contains("no whole png"));
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
  const std::string svg = Render(stack, FigureFormat::kSvg);
  CHECK_THAT(svg, Contains("upper") && Contains("lower"));
}

}  // namespace
}  // namespace rift::report
