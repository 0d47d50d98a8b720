# Thin front door: each line calls a script. `make help` lists them.
.PHONY: help setup demo test check bench lint format docs coverage sanitize fuzz package clean

help:      ## this list
	@sed -n 's/^\([a-z]*\): *## */  make \1\t/p' Makefile | expand -t 20
setup:     ## install the Debian packages that building and testing need
	@scripts/setup.sh
demo:      ## simulate a drive, run the odometry on it, write a report
	@scripts/demo.sh
test:      ## build all and run the tests
	@scripts/test.sh
check:     ## all that checks: tests, lint, docs, sanitizers, fuzzing, coverage, instructions; hours
	@scripts/check.sh
bench:     ## build and run the benchmarks
	@scripts/bench.sh
lint:      ## clang-format, clang-tidy, links, paths
	@scripts/lint.sh
format:    ## rewrite our C++ files in the project's format
	@scripts/format.sh
docs:      ## documents and reference of the public headers as one site
	@scripts/docs.sh
coverage:  ## line coverage of the core, at least 90 %
	@scripts/coverage.sh
sanitize:  ## the tests under AddressSanitizer and UBSan
	@scripts/sanitize.sh
fuzz:      ## a minute of fuzzing for each parser
	@scripts/fuzz.sh
package:   ## Debian packages in build/package
	@scripts/package.sh
clean:     ## remove build/ and out/
	@rm -rf build out
