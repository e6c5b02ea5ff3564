# The commands of the README, each the only thing to type.
.PHONY: demo docs test

demo: ## run the main-bearing study and print where its report is
	@.ci/setup
	@.venv/bin/fe-drivetrain run main_bearing/rmse

# Bytecode is written even where the machine says not to: every process of the tests would compile all
# sources again.
test: ## run the whole test suite
	@.ci/setup test
	@PYTHONDONTWRITEBYTECODE= .venv/bin/python -m pytest -q -n auto

docs: ## build the documentation into build/docs
	@.ci/setup docs
	@.ci/docs
	@echo build/docs/index.html
