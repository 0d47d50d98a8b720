#!/usr/bin/env bash
# Everything that checks the project, one phase after the other, with a summary at the end. A phase that fails does not
# keep the next ones from running; the exit code is 1 if one did. Logs: build/check/PHASE.log.
#
#   scripts/check.sh                     all phases, several hours
#   scripts/check.sh test lint           these alone
#   scripts/check.sh --stop test lint    ends at the first that fails
#
#   test            all tests, optimised build
#   lint            clang-format, clang-tidy, includes, shellcheck, links, paths
#   separate        each source of the libraries, the command and the tests compiled by itself, not as a unity build
#   docs            the site of documents and reference; wrong names and links are errors
#   sanitize        all tests under AddressSanitizer and UBSan
#   sanitize-short  the same for the tests of the libraries, without long drives and without those that run the command
#   threads         tests of what runs in several threads under ThreadSanitizer: the stages, sources, queues, the viewer
#   fuzz            every parser, RILO_FUZZ_SECONDS (60) each
#   coverage        lines of the core that its tests reach, at least 90 %
#   instructions    instructions a sweep, against benchmarks/instructions.txt
#   package         Debian packages with shared libraries; the command in them simulates and runs a drive
#   arm             the core's tests, cross-compiled for 64-bit ARM, under qemu
#   wheel           the source package; a wheel for Debian's Python, in an empty environment: tests, same poses
#   wheels          the same for each Python that is here, Debian's among them
# Not among "all", since another one does it, too: sanitize-short, wheel.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

phases=(test lint separate docs sanitize threads fuzz coverage instructions package arm wheels)

# Long drives under sanitizers take half an hour. Of the trial of points without times, the short cases are enough.
long='Elevation.(AnErrorIsFound|ASensorWithoutError)|BeamCalibration.AWorseUnit|Covariance|SameAsCommand'
long+='|CompensationTrial.(NotCertain|TimedSweeps|DoesNotDepend|ObserversAreTold|ARun|PointsInAnotherOrder)'
# What has threads of its own, and what runs in oneTBB's; and the programs with these tests.
threaded='Pipeline|TimeBudget|Preprocess|ValidPoints|IsolatedReturns|VoxelMean|BeamIndex|Deskew|LocalMap|UnevenMotion|Deadlines|CoarseRegistration|AdaptiveIcp|PrefetchSource|Live(Source|Queue)|View(Server|History)'
threaded_programs='cloud_test map_test registration_test calibration_test pipeline_test io_test view_test'

run_phase() {
  case "$1" in
    test) scripts/test.sh --all ;;
    lint) scripts/lint.sh ;;
    separate) scripts/separate.sh ;;
    docs) scripts/docs.sh ;;
    sanitize) scripts/sanitize.sh ;;
    sanitize-short)
      TARGETS=library_tests scripts/sanitize.sh --label-regex '^library$' --exclude-regex "^($long)" ;;
    threads)
      PRESET=tsan TARGETS="$threaded_programs" scripts/sanitize.sh --tests-regex "$threaded" --exclude-regex "^($long)" ;;
    fuzz) scripts/fuzz.sh "${RILO_FUZZ_SECONDS:-60}" ;;
    coverage) scripts/coverage.sh ;;
    instructions) scripts/instructions.sh ;;
    package) scripts/package.sh --try ;;
    arm) scripts/arm.sh ;;
    wheel) scripts/wheel.sh --sdist --try && scripts/wheel.sh --try ;;
    wheels) scripts/wheel.sh --sdist --try && scripts/wheel.sh --all --try ;;
  esac
}

# The line of a log that says how it went.
verdict() {
  grep -hE 'tests passed, .* tests failed out of|^lint: clean|^lint.sh: failed|^Site: |^separate: |nothing found$|^lines: |^committed: |^packages: |^wheel: ' \
    "$1" | tail -n 1 || true
}

stop=false
chosen=()
for argument in "$@"; do
  case "$argument" in
    --stop) stop=true ;;
    -*) die "unknown option '$argument'; known: --stop" ;;
    *)
      [[ " ${phases[*]} sanitize-short wheel " == *" $argument "* ]] ||
        die "unknown phase '$argument'; known: ${phases[*]} sanitize-short wheel"
      chosen+=("$argument")
      ;;
  esac
done
[ ${#chosen[@]} -eq 0 ] || phases=("${chosen[@]}")

mkdir -p build/check
summary=()
failed=0
for phase in "${phases[@]}"; do
  log="build/check/$phase.log"
  echo "=== $phase"
  start=$SECONDS
  result=passed
  (run_phase "$phase") 2>&1 | tee "$log" || {
    result=FAILED
    failed=1
  }
  summary+=("$(printf '%-15s %-7s %5d s  %s' "$phase" "$result" $((SECONDS - start)) "$(verdict "$log")")")
  echo "=== $phase: $result after $((SECONDS - start)) s"
  if $stop && [ "$failed" -ne 0 ]; then
    break
  fi
done

echo
printf '%s\n' "${summary[@]}"
exit "$failed"
