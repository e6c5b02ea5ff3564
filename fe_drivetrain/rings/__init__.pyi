from .housing import HousingSolid as HousingSolid
from .housing import contact_compliance as contact_compliance
from .housing import contact_rows as contact_rows
from .housing import housing_races as housing_races
from .housing import housing_solid as housing_solid
from .of_revolution import races_of_revolution as races_of_revolution
