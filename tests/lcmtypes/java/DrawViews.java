// SPDX-License-Identifier: BSD-3-Clause
// Opens each of our lcm-spy plugins on the messages of a log, without a screen, and looks at what it draws.
// Exit code 1 when a plugin draws nothing, or when one of its messages has no plugin. A folder as second argument: pictures are kept there.
//   java -Djava.awt.headless=true -cp lcm.jar:jchart2d.jar:ladder_msgs.jar DrawViews.java messages.log [FOLDER]

import java.awt.Component;
import java.awt.Dimension;
import java.awt.event.ActionEvent;
import java.awt.image.BufferedImage;
import java.io.EOFException;
import java.io.File;
import java.nio.ByteBuffer;
import java.util.HashMap;
import java.util.HashSet;
import java.util.Map;
import java.util.Set;
import javax.imageio.ImageIO;
import javax.swing.JDesktopPane;
import javax.swing.JInternalFrame;
import lcm.lcm.LCMDataInputStream;
import lcm.logging.Log;
import lcm.spy.ChannelData;
import lcm.spy.LCMTypeDatabase;
import lcm.spy.SpyPlugin;

public final class DrawViews {
    private static final String[] PLUGINS = {"DepthImage", "TopologyView", "RungsView", "HealthLamps"};
    private static final int MIN_COLORS = 3;

    public static void main(String[] arguments) throws Exception {
        final Map<String, Object> newest = new HashMap<>();
        final LCMTypeDatabase types = new LCMTypeDatabase();
        final Log log = new Log(arguments[0], "r");
        while (true) {
            try {
                final Log.Event event = log.readNext();
                final Class<?> type = types.getClassByFingerprint(ByteBuffer.wrap(event.data).getLong());
                if (type != null) newest.put(event.channel, type.getConstructor(java.io.DataInput.class).newInstance(new LCMDataInputStream(event.data)));
            } catch (EOFException end) {
                break;
            }
        }
        int failed = 0;
        for (String name : PLUGINS) {
            final SpyPlugin plugin = (SpyPlugin) Class.forName("ladder_spy." + name).getConstructor().newInstance();
            int drawn = 0;
            for (Map.Entry<String, Object> entry : newest.entrySet()) {
                final long fingerprint = entry.getValue().getClass().getField("LCM_FINGERPRINT").getLong(null);
                if (!plugin.canHandle(fingerprint)) continue;
                final BufferedImage image = draw(plugin, entry.getKey(), entry.getValue());
                final int colors = colorsOf(image);
                System.out.println(name + " " + entry.getKey() + ": " + colors + " colours");
                if (arguments.length > 1) ImageIO.write(image, "png", new File(arguments[1], name + "-" + entry.getKey() + ".png"));
                drawn += colors >= MIN_COLORS ? 1 : 0;
            }
            if (drawn == 0) {
                System.out.println(name + " draws nothing");
                ++failed;
            }
        }
        System.exit(failed == 0 ? 0 : 1);
    }

    private static BufferedImage draw(SpyPlugin plugin, String name, Object message) {
        final JDesktopPane desktop = new JDesktopPane();
        final ChannelData channel = new ChannelData();
        channel.name = name;
        channel.last = message;
        plugin.getAction(desktop, channel).actionPerformed(new ActionEvent(desktop, 0, "open"));
        final Component view = ((JInternalFrame) desktop.getComponent(0)).getContentPane().getComponent(0);
        final Dimension size = view.getPreferredSize();
        view.setSize(size);
        final BufferedImage image = new BufferedImage(size.width, size.height, BufferedImage.TYPE_INT_RGB);
        view.paint(image.createGraphics());
        return image;
    }

    private static int colorsOf(BufferedImage image) {
        final Set<Integer> colors = new HashSet<>();
        for (int y = 0; y < image.getHeight(); ++y) {
            for (int x = 0; x < image.getWidth(); ++x) colors.add(image.getRGB(x, y));
        }
        return colors.size();
    }
}
