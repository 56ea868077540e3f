/* The public header stands alone, may be included twice, and its initialisers fit its structs in every language that
   compiles this file. */
#include <talus/talus.h>

int main(void) {
    talus_options options = TALUS_OPTIONS_INIT;
    talus_array array = TALUS_ARRAY_INIT;
    talus_field field = TALUS_FIELD_INIT;
    talus_step_report report = TALUS_STEP_REPORT_INIT;
    talus_event event = TALUS_EVENT_INIT;
    talus_history history = TALUS_HISTORY_INIT;
    talus_raster raster = TALUS_RASTER_INIT;
    return options.struct_size && array.struct_size && field.struct_size && report.struct_size && event.struct_size &&
                   history.struct_size && raster.struct_size
               ? 0
               : 1;
}
