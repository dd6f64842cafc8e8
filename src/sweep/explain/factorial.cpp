#include "rift/sweep/explain/factorial.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "rift/statistics/inference.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {
namespace {

constexpr int kMostColumns = 300;  ///< a larger model costs seconds and explains nothing to anyone
constexpr double kFewestResidualDf = 2.0;

/// A value of a parameter in a row as sum-to-zero coding: level i of k is the i-th unit vector, the
/// last one is -1 everywhere.
class Coding {
 public:
  Coding(const SweepResult& result, const std::vector<int>& rows, int parameter)
      : parameter_(parameter) {
    for (const int row : rows) {
      index_.emplace(result.rows[row].theta[parameter], static_cast<int>(index_.size()));
    }
  }
  int parameter() const { return parameter_; }
  int Columns() const { return static_cast<int>(index_.size()) - 1; }
  Eigen::VectorXd Of(const TrialRow& row) const {
    const int level = index_.at(row.theta[parameter_]);
    if (level == Columns()) return Eigen::VectorXd::Constant(Columns(), -1.0);
    return Eigen::VectorXd::Unit(Columns(), level);
  }

 private:
  int parameter_;
  std::map<experiment::ParameterValue, int> index_;
};

struct Term {
  std::vector<int> codings;  ///< one or two
  int first = 0;             ///< its columns
  int columns = 0;
};

struct Fit {
  double sse = 0.0;
  double rank = 0.0;
};

/// The normal equations of all terms, of which any subset of terms can be fitted.
class LinearModel {
 public:
  LinearModel(const SweepResult& result, const std::vector<int>& rows,
              const std::vector<Coding>& codings, std::vector<Term> terms)
      : terms_(std::move(terms)) {
    int columns = 1;
    for (Term& term : terms_) {
      term.first = columns;
      columns += term.columns;
    }
    xx_ = Eigen::MatrixXd::Zero(columns, columns);
    xy_ = Eigen::VectorXd::Zero(columns);
    double mean_m = 0.0;
    for (const int row : rows) {
      mean_m += Loss_m(result.rows[row], result.gap.threshold_m) / static_cast<double>(rows.size());
    }
    Eigen::VectorXd x(columns);
    for (const int row : rows) {
      FillRow(codings, result.rows[row], x);
      const double y = Loss_m(result.rows[row], result.gap.threshold_m) - mean_m;
      xx_.selfadjointView<Eigen::Lower>().rankUpdate(x);
      xy_ += y * x;
      yy_ += y * y;
    }
    xx_ = xx_.selfadjointView<Eigen::Lower>();
  }

  const std::vector<Term>& terms() const { return terms_; }
  double Total() const { return yy_; }

  /// Least squares with the intercept and the terms that are wanted; combinations that were never
  /// tried cost rank, not sense.
  Fit With(const std::function<bool(int term)>& is_wanted) const {
    std::vector<int> columns{0};
    for (int t = 0; t < static_cast<int>(terms_.size()); ++t) {
      if (!is_wanted(t)) continue;
      for (int i = 0; i < terms_[t].columns; ++i) columns.push_back(terms_[t].first + i);
    }
    const Eigen::MatrixXd xx = xx_(columns, columns);
    const Eigen::VectorXd xy = xy_(columns);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(xx);
    const double least = 1e-10 * solver.eigenvalues().maxCoeff();
    const Eigen::VectorXd along = solver.eigenvectors().transpose() * xy;
    Fit fit{yy_, 0.0};
    for (int i = 0; i < along.size(); ++i) {
      if (solver.eigenvalues()[i] <= least) continue;
      fit.sse -= along[i] * along[i] / solver.eigenvalues()[i];
      fit.rank += 1.0;
    }
    const bool is_exact = fit.sse < 1e-12 * yy_;  // rounding of the normal equations
    if (is_exact) fit.sse = 0.0;
    return fit;
  }

 private:
  void FillRow(const std::vector<Coding>& codings, const TrialRow& row, Eigen::VectorXd& x) const {
    x[0] = 1.0;
    for (const Term& term : terms_) {
      const Eigen::VectorXd a = codings[term.codings[0]].Of(row);
      if (term.codings.size() == 1) {
        x.segment(term.first, term.columns) = a;
        continue;
      }
      const Eigen::VectorXd b = codings[term.codings[1]].Of(row);
      for (int i = 0; i < a.size(); ++i) x.segment(term.first + i * b.size(), b.size()) = a[i] * b;
    }
  }

  std::vector<Term> terms_;
  Eigen::MatrixXd xx_;
  Eigen::VectorXd xy_;
  double yy_ = 0.0;
};

std::vector<Coding> VariedParameters(const SweepResult& result, const std::vector<int>& rows) {
  std::vector<Coding> codings;
  for (int i = 0; i < static_cast<int>(result.parameters.size()); ++i) {
    if (result.parameters[i].IsContinuous()) continue;
    Coding coding(result, rows, i);
    if (coding.Columns() > 0) codings.push_back(std::move(coding));
  }
  return codings;
}

std::vector<Term> MainTerms(const std::vector<Coding>& codings) {
  std::vector<Term> terms;
  for (int i = 0; i < static_cast<int>(codings.size()); ++i) {
    terms.push_back({.codings = {i}, .columns = codings[i].Columns()});
  }
  return terms;
}

std::vector<Term> WithInteractions(const std::vector<Coding>& codings) {
  std::vector<Term> terms = MainTerms(codings);
  for (int i = 0; i < static_cast<int>(codings.size()); ++i) {
    for (int j = i + 1; j < static_cast<int>(codings.size()); ++j) {
      terms.push_back({.codings = {i, j}, .columns = codings[i].Columns() * codings[j].Columns()});
    }
  }
  return terms;
}

int ColumnCount(const std::vector<Term>& terms) {
  int columns = 1;
  for (const Term& term : terms) columns += term.columns;
  return columns;
}

bool Contains(const Term& larger, const Term& smaller) {
  return larger.codings.size() > smaller.codings.size() &&
         std::find(larger.codings.begin(), larger.codings.end(), smaller.codings.front()) !=
             larger.codings.end();
}

/// The noncentrality at which `holds(lambda)`, falling in lambda, becomes false; 0 when at once.
double LargestNoncentrality(const std::function<bool(double)>& holds) {
  constexpr double kLargest = 1e7;
  if (!holds(0.0)) return 0.0;
  double low = 0.0, high = 1.0;
  while (holds(high) && high < kLargest) low = std::exchange(high, 2.0 * high);
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

void SetShare(FactorialTerm& term, double residual_df, int n) {
  const double gain = term.df * (term.f - 1.0);
  term.share = std::max(0.0, gain / (gain + n));
  const auto share_at = [&](double tail) {
    const double lambda = LargestNoncentrality([&](double l) {
      return statistics::NoncentralFCdf(term.df, residual_df, l, term.f) > tail;
    });
    return lambda / (lambda + n);
  };
  term.share_low = share_at(0.975);
  term.share_high = share_at(0.025);
}

FactorialTerm Judge(const SweepResult& result, const std::vector<Coding>& codings,
                    const LinearModel& model, int index, const FactorialAnalysis& analysis) {
  const std::vector<Term>& terms = model.terms();
  FactorialTerm term;
  for (const int coding : terms[index].codings) {
    term.parameters.push_back(codings[coding].parameter());
    term.name +=
        (term.name.empty() ? "" : " x ") + result.parameters[codings[coding].parameter()].Name();
  }
  const auto beside = [&](int other) {
    return other != index && !Contains(terms[other], terms[index]);
  };
  const Fit without = model.With(beside);
  const Fit with = model.With([&](int other) { return other == index || beside(other); });
  term.df = with.rank - without.rank;
  const double mse = std::pow(analysis.residual_sd_m, 2);
  if (term.df < 1.0 || !(mse > 0.0)) return term;
  term.f = std::max(0.0, without.sse - with.sse) / term.df / mse;
  term.p = statistics::FUpperTail(term.df, analysis.residual_df, term.f);
  SetShare(term, analysis.residual_df, analysis.n);
  return term;
}

}  // namespace

const FactorialTerm* FactorialAnalysis::Main(int parameter) const {
  const auto is_it = [&](const FactorialTerm& term) {
    return !term.IsInteraction() && term.parameters.front() == parameter;
  };
  const auto found = std::find_if(terms.begin(), terms.end(), is_it);
  return found == terms.end() ? nullptr : &*found;
}

FactorialAnalysis AnalyseFactors(const SweepResult& result) {
  FactorialAnalysis analysis;
  const std::vector<int> rows = RowsThatCount(result);
  analysis.n = static_cast<int>(rows.size());
  std::vector<Coding> codings = VariedParameters(result, rows);
  std::erase_if(codings, [](const Coding& coding) { return coding.Columns() > kMostColumns; });
  if (codings.empty() || ColumnCount(MainTerms(codings)) > kMostColumns) return analysis;
  std::vector<Term> terms = WithInteractions(codings);
  const auto leaves_enough = [&](const std::vector<Term>& some) {
    return ColumnCount(some) <= kMostColumns && analysis.n - ColumnCount(some) >= kFewestResidualDf;
  };
  analysis.has_interactions = codings.size() > 1 && leaves_enough(terms);
  if (!analysis.has_interactions) terms = MainTerms(codings);

  const LinearModel model(result, rows, codings, terms);
  const Fit all = model.With([](int) { return true; });
  analysis.residual_df = analysis.n - all.rank;
  if (model.Total() > 0.0) analysis.explained = 1.0 - all.sse / model.Total();
  if (analysis.residual_df >= 1.0) {
    analysis.residual_sd_m = std::sqrt(all.sse / analysis.residual_df);
  }
  for (int i = 0; i < static_cast<int>(terms.size()); ++i) {
    analysis.terms.push_back(Judge(result, codings, model, i, analysis));
  }
  return analysis;
}

double SmallestDetectable(const std::vector<int>& counts, double sd, double residual_df,
                          double power) {
  const double levels = static_cast<double>(counts.size());
  double inverse = 0.0;
  for (const int n : counts) inverse += 1.0 / n;
  if (levels < 2.0 || residual_df < 1.0 || !(sd > 0.0) || !std::isfinite(inverse)) {
    return gap::kNotComputed;
  }
  const double df = levels - 1.0;
  const double critical = statistics::FCriticalValue(df, residual_df, kSignificance);
  const double lambda = LargestNoncentrality([&](double l) {
    return statistics::NoncentralFCdf(df, residual_df, l, critical) > 1.0 - power;
  });
  // Two means at -d/2 and d/2 with n trials each: lambda = n d^2 / (2 sd^2).
  return sd * std::sqrt(2.0 * lambda * inverse / levels);
}

}  // namespace rift::sweep
