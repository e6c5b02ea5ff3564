# The commands of the README, each the only thing to type.
.PHONY: cases demo docs test

demo: ## run the main-bearing study and print where its report is
	@.ci/setup
	@.venv/bin/fe-drivetrain run main_bearing/rmse

# Bytecode is written even where the machine says not to: every process of the tests would compile all
# sources again.
test: ## run the tests
	@.ci/setup test
	@PYTHONDONTWRITEBYTECODE= .venv/bin/python -m pytest -q -n auto

cases: ## run every case in its quick form, and test what each of them answers
	@.ci/setup test
	@.venv/bin/fe-drivetrain run --all --quick --out $(CURDIR)/build/cases
	@FE_DRIVETRAIN_QUICK_RUNS=$(CURDIR)/build/cases .venv/bin/python -m pytest -q -n auto tests/cases

docs: ## build the documentation into build/docs
	@.ci/setup docs
	@.ci/docs
	@echo build/docs/index.html
