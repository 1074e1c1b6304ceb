# The front door: `make demo` and `make test` on a machine that has nothing but git, make and apt.
# Thin on purpose: the logic is in CMakePresets.json, deploy/install-deps and the eciton command.

# The DDS vendor of the demo (fastdds, cyclonedds, mixed), and more options for it: make demo DDS=fastdds ARGS="--modules 2"
DDS ?=
ARGS ?=
JOBS ?= $(shell nproc)

.PHONY: demo test build benchmarks nightly format format-check clean install-deps help

demo: install-deps
	cmake --preset release
	cmake --build --preset release --target programs
	build/release/bin/eciton demo $(if $(DDS),--dds $(DDS)) $(ARGS)

test: install-deps
	cmake --preset dev
	cmake --build --preset dev
	ctest --preset dev -j $(JOBS) $(ARGS)

build: install-deps
	cmake --preset release
	cmake --build --preset release --target programs

# What `eciton bench` measures with.
benchmarks: install-deps
	cmake --preset release
	cmake --build --preset release --target bench_programs

# More seeds and longer flights: tests read ECITON_NIGHTLY, and those of configuration `nightly` run only here.
nightly: install-deps
	cmake --preset release
	cmake --build --preset release
	ECITON_NIGHTLY=1 ctest --preset release -C nightly -j $(JOBS) $(ARGS)

sources = find core idl services hal deploy tests benchmarks -name '*.[ch]' -print0 -o -name '*.[ch]pp' -print0

format:
	$(sources) | xargs -0 clang-format -i

format-check:
	$(sources) | xargs -0 clang-format --dry-run -Werror

clean:
	rm -rf build

install-deps:
	deploy/install-deps

help:
	@echo "make demo [DDS=fastdds|cyclonedds] [ARGS=...]   fly the demo"
	@echo "make test [ARGS='-R name']                      build and run the tests"
	@echo "make build | benchmarks | nightly | format | format-check | clean | install-deps"
